//! The difference of two pictures.

use strahl_shade::srgb;

/// The difference of two pictures, per channel, in units of unrounded 8-bit sRGB codes: 1 is just about visible.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Difference {
    /// Root of the mean squared difference.
    pub rms: [f64; 3],
    /// Largest difference of a pixel.
    pub max: [f64; 3],
}

/// Compares the linear colours of two pictures as they are displayed: clamped to `0..=1` and sRGB encoded, NaN as 0.
///
/// `None` if the pictures have different numbers of pixels; no pixels differ by nothing.
pub fn compare(a: &[[f32; 3]], b: &[[f32; 3]]) -> Option<Difference> {
    if a.len() != b.len() {
        return None;
    }
    let mut difference = Difference::default();
    for (a, b) in a.iter().zip(b) {
        for channel in 0..3 {
            let distance = (shown(a[channel]) - shown(b[channel])).abs();
            difference.rms[channel] += distance * distance;
            if distance > difference.max[channel] {
                difference.max[channel] = distance;
            }
        }
    }
    let count = a.len().max(1) as f64;
    difference.rms = difference.rms.map(|sum| (sum / count).sqrt());
    Some(difference)
}

/// The 8-bit code before rounding.
fn shown(linear: f32) -> f64 {
    if linear > 0.0 {
        255.0 * srgb::encode(f64::from(linear.min(1.0)))
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_measured_in_codes() {
        let color = |code| [srgb::decode_u8(code), 0.5, f32::NAN];
        let a = [color(100), color(50), color(7), color(255)];
        let b = [color(103), color(46), color(7), [9.0, 0.5, -4.0]];
        let difference = compare(&a, &b).unwrap();
        assert!((difference.rms[0] - 2.5).abs() < 1e-4);
        assert!((difference.max[0] - 4.0).abs() < 1e-4);
        assert_eq!((difference.rms[1], difference.max[2]), (0.0, 0.0));
        assert_eq!(compare(&[], &[]), Some(Difference::default()));
        assert_eq!(compare(&a, &b[1..]), None);
    }
}
