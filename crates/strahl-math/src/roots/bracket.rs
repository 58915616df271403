/// The root of a function that has opposite signs at the ends of an interval, to the last bit the function can resolve
/// (a root of multiplicity m to about m of them).
///
/// `function` returns value and derivative. Newton's method, kept inside the bracket: a step that would leave it, or one
/// that doesn't at least halve the step before the last, is replaced by a bisection, so there are at most about
/// twice as many evaluations as bisection needs (Press et al., Numerical Recipes, 3rd ed., section 9.4). `rising`
/// tells that the function is negative at `low`; `start` is a first guess, the middle is taken if it is not inside. The values at the ends are not evaluated; if there is no change of sign, or
/// the function returns NaN, the result is some point of the interval.
pub fn find_root(
    low: f64,
    high: f64,
    rising: bool,
    start: f64,
    mut function: impl FnMut(f64) -> (f64, f64),
) -> f64 {
    let (mut low, mut high) = (low, high);
    let mut x = if low < start && start < high {
        start
    } else {
        0.5 * (low + high)
    };
    let (mut step_before, mut step) = (high - low, high - low);
    // Bisection alone would need 53 steps, and some more towards a root near zero.
    for _ in 0..200 {
        let (value, slope) = function(x);
        if value == 0.0 {
            return x;
        }
        if (value < 0.0) == rising {
            low = x;
        } else {
            high = x;
        }
        let newton = x - value / slope;
        let before_last = step_before;
        step_before = step;
        let inside = low < newton && newton < high;
        let next = if inside && (newton - x).abs() * 2.0 < before_last.abs() {
            newton
        } else if (newton - x).abs() <= x.abs() * f64::EPSILON {
            // The root is at x as far as f64 can tell, at the very end of the bracket.
            return x;
        } else {
            0.5 * (low + high)
        };
        step = next - x;
        if step.abs() <= x.abs() * (0.5 * f64::EPSILON) || next <= low || next >= high {
            return next;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::find_root;

    #[test]
    fn roots_are_exact_to_the_last_bit() {
        let root = find_root(0.0, 2.0, true, f64::NAN, |x| (x * x - 2.0, 2.0 * x));
        assert!((root - std::f64::consts::SQRT_2).abs() <= 2.0 * f64::EPSILON);
        let falling = find_root(-3.0, 1.0, false, f64::NAN, |x| (-x - 0.1, -1.0));
        assert_eq!(falling, -0.1);
        assert_eq!(
            find_root(0.0, 1.0, true, f64::NAN, |x| (x - 1e-12, 1.0)),
            1e-12
        );
    }

    #[test]
    fn flat_and_steep_functions_converge() {
        let mut evaluations = 0;
        let root = find_root(-1.0, 2.0, true, f64::NAN, |x| {
            evaluations += 1;
            let y: f64 = x - 0.3;
            (y * y * y * y * y, 5.0 * y * y * y * y)
        });
        assert!(
            (root - 0.3).abs() < 1e-15 && evaluations < 120,
            "{root} after {evaluations}"
        );
        // A derivative that lies.
        let root = find_root(0.0, 1.0, true, f64::NAN, |x| (x - 0.3, -7.0));
        assert!((root - 0.3).abs() < 1e-15);
    }

    #[test]
    fn nonsense_ends() {
        assert!(
            (0.0..=1.0).contains(&find_root(0.0, 1.0, true, f64::NAN, |_| (
                f64::NAN,
                f64::NAN
            )))
        );
        assert!((0.0..=1.0).contains(&find_root(0.0, 1.0, true, f64::NAN, |_| (1.0, 0.0))));
    }
}
