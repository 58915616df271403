/// Less than a rounding error of a parameter that runs from 0 to 1.
const SMALLEST: f64 = 0.25 * f64::EPSILON;

/// The root of a smooth function that has opposite signs at the ends of an interval within 0 to 1, up to the rounding errors of
/// the function and a unit of 2⁻⁵³.
///
/// `function` returns the value and Newton's step, which is the value divided by the slope; `rising` tells that the function is
/// negative at `low`; `guess` is the first guess, the middle is taken if it is not inside. In contrast to [`super::find_root`], the
/// last step is not verified: Newton's method converges quadratically, so after steps of the sizes `a` and `b` the next one has about the
/// size `b (b / a)²`, and where that is less than a rounding error it is not computed. This saves a call or two, and never
/// takes rounding errors for progress. A step that leaves the interval, or is not half the one before, is replaced by halving
/// the interval.
#[inline]
pub fn newton(
    mut low: f64,
    mut high: f64,
    rising: bool,
    guess: f64,
    mut function: impl FnMut(f64) -> (f64, f64),
) -> f64 {
    let mut s = if low < guess && guess < high {
        guess
    } else {
        0.5 * (low + high)
    };
    // The size of the last step, if it was one of Newton's.
    let mut before: Option<f64> = None;
    // Halving alone takes 53 steps, and each of Newton's is followed by a shorter one or by halving.
    for _ in 0..200 {
        let (value, step) = function(s);
        if value == 0.0 {
            return s;
        }
        if (value < 0.0) == rising {
            low = s;
        } else {
            high = s;
        }
        let (next, size) = (s - step, step.abs());
        if low < next && next < high && before.is_none_or(|before| size < 0.5 * before) {
            let part = before.map_or(1.0, |before| size / before);
            if size <= SMALLEST || size * part * part <= SMALLEST {
                return next;
            }
            (s, before) = (next, Some(size));
        } else {
            let half = 0.5 * (low + high);
            if size <= SMALLEST || half <= low || high <= half {
                return s;
            }
            (s, before) = (half, None);
        }
    }
    s
}

#[cfg(test)]
mod tests {
    use super::newton;

    #[test]
    fn few_calls_are_enough() {
        // Newton's steps towards a root beside an end lead out of the interval, which is halved instead.
        for (root, rising, most) in [
            (0.3, true, 6),
            (1e-9, true, 6),
            (0.75, false, 6),
            (1.0 - 1e-12, false, 30),
        ] {
            let sign = if rising { 1.0 } else { -1.0 };
            let mut calls = 0;
            let found = newton(0.0, 1.0, rising, 0.5, |s| {
                calls += 1;
                let (value, slope) = ((s - root) * (2.0 + s), 2.0 + 2.0 * s - root);
                (sign * value, value / slope)
            });
            assert!((found - root).abs() <= f64::EPSILON, "{root}: {found}");
            assert!(calls <= most, "{root}: {calls}");
        }
    }

    #[test]
    fn rounding_errors_end_the_search() {
        // A value with noise of 1e-13, as the height of a small arc on a large body.
        let mut calls = 0;
        let found = newton(0.0, 1.0, true, 0.9, |s| {
            calls += 1;
            let value = ((s - 0.3) * (1.0 + s) + 1000.0) - 1000.0;
            (value, value / (0.7 + 2.0 * s))
        });
        assert!(
            (found - 0.3).abs() < 2e-13 && calls < 8,
            "{found} after {calls}"
        );
    }

    #[test]
    fn steps_that_lead_astray_are_replaced_by_halving() {
        // Steps in the wrong direction, too long, zero, or none at all.
        for step in [-0.1, 7.0, 0.0, f64::NAN] {
            let found = newton(0.0, 1.0, true, 0.9, |s| (s - 0.3, step));
            assert!((0.0..=1.0).contains(&found), "{step}: {found}");
        }
        let found = newton(0.0, 1.0, true, 0.9, |s| (s - 0.3, -(s - 0.3)));
        assert!((found - 0.3).abs() < 1e-15, "{found}");
        let flat = newton(-1.0, 1.0, true, 0.9, |s| {
            let y = s - 0.3;
            (y * y * y, y / 3.0)
        });
        assert!((flat - 0.3).abs() < 1e-15, "{flat}");
        let found = newton(0.0, 1.0, true, f64::NAN, |_| (f64::NAN, f64::NAN));
        assert!((0.0..=1.0).contains(&found));
    }
}
