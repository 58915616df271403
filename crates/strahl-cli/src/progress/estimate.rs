//! Estimates the remaining time: of this pass from its tiles, of later passes and frames from the earlier ones.

use std::time::Duration;

/// The times of the passes of one picture.
#[derive(Clone, Debug, Default)]
pub(super) struct Estimate {
    /// Seconds of each finished pass.
    done: Vec<f64>,
    /// The number of passes of the picture, at least 1.
    passes: u32,
}

/// The time of a refinement pass, relative to the pass before it: four times the rays for a fifth of the pixels is typical of
/// scenes with edges and textures.
const USUAL: f64 = 0.8;

impl Estimate {
    /// Starts a pass; the one before took `before` seconds.
    pub(super) fn pass(&mut self, pass: u32, passes: u32, before: f64) {
        self.passes = passes.max(1);
        if pass == 0 {
            self.done.clear();
        } else {
            self.done.push(before);
        }
    }

    /// Seconds spent on the picture and seconds left, when a fraction `part` of the pass is done after `elapsed` seconds.
    pub(super) fn seconds(&self, part: f64, elapsed: f64) -> (f64, f64) {
        let spent: f64 = self.done.iter().sum::<f64>() + elapsed;
        // There is no estimate before the first tile is done.
        if part <= 0.0 {
            return (spent, f64::INFINITY);
        }
        let whole = elapsed / part.min(1.0);
        let later = (self.passes as usize).saturating_sub(self.done.len() + 1);
        let mut next = whole;
        let mut left = (whole - elapsed).max(0.0);
        for _ in 0..later {
            next *= USUAL;
            left += next;
        }
        (spent, left)
    }
}

/// A time for people: `7 s`, `3 min 20 s`, `2 h 5 min`.
pub(super) fn words(seconds: f64) -> String {
    if !seconds.is_finite() {
        return "?".to_owned();
    }
    let s = Duration::from_secs_f64(seconds.clamp(0.0, 1e9)).as_secs();
    match s {
        0..60 => format!("{s} s"),
        60..3600 => format!("{} min {} s", s / 60, s % 60),
        _ => format!("{} h {} min", s / 3600, s / 60 % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_counts_all_passes() {
        let mut estimate = Estimate::default();
        estimate.pass(0, 1, 0.0);
        assert_eq!(estimate.seconds(0.25, 1.0), (1.0, 3.0));
        assert_eq!(estimate.seconds(0.0, 1.0), (1.0, f64::INFINITY));
        estimate.pass(0, 3, 0.0);
        let (spent, left) = estimate.seconds(0.5, 5.0);
        assert!(
            spent == 5.0 && (left - (5.0 + 8.0 + 6.4)).abs() < 1e-9,
            "{left}"
        );
        estimate.pass(1, 3, 10.0);
        let (spent, left) = estimate.seconds(0.5, 1.0);
        assert!(spent == 11.0 && (left - (1.0 + 1.6)).abs() < 1e-9, "{left}");
        estimate.pass(2, 3, 2.0);
        assert_eq!(estimate.seconds(1.0, 4.0), (16.0, 0.0));
    }

    #[test]
    fn times_are_said_as_people_say_them() {
        assert_eq!(words(7.9), "7 s");
        assert_eq!(words(200.0), "3 min 20 s");
        assert_eq!(words(7500.0), "2 h 5 min");
        assert_eq!(words(f64::INFINITY), "?");
    }
}
