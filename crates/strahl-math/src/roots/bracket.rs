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

/// A place where a function changes its sign, from values alone: for functions whose derivative is dear.
///
/// `at_low` and `at_high` are the values at the ends, of opposite signs. The result is within about two units in the last place of
/// a zero or jump. Inverse quadratic interpolation where the last three points allow it, else bisection (T. R. Chandrupatla,
/// "A new hybrid quadratic/bisection algorithm for finding the zero of a nonlinear function without using derivatives",
/// Advances in Engineering Software 28, 1997). Infinite values are fine; with NaN the result is some point of the interval.
pub fn find_crossing(
    low: f64,
    high: f64,
    at_low: f64,
    at_high: f64,
    function: impl FnMut(f64) -> f64,
) -> f64 {
    find_crossing_until([low, high], [at_low, at_high], function, |_, _| false)
}

/// [`find_crossing`] between two places with these values, which also ends at a place where the value is small enough: `is_enough` is given the
/// absolute value, and that of the slope from there to the other end of what is left.
pub fn find_crossing_until(
    [low, high]: [f64; 2],
    [at_low, at_high]: [f64; 2],
    mut function: impl FnMut(f64) -> f64,
    is_enough: impl Fn(f64, f64) -> bool,
) -> f64 {
    // x1 is the newest point, x2 the end on the other side of the zero, x3 the point before.
    let (mut x1, mut f1) = (low, at_low);
    let (mut x2, mut f2) = (high, at_high);
    let mut part = 0.5;
    // Bisection alone would need 53 steps, and some more towards a zero near 0.
    for _ in 0..200 {
        let x = x1 + part * (x2 - x1);
        let f = function(x);
        let (x3, f3);
        if (f < 0.0) == (f1 < 0.0) {
            (x3, f3) = (x1, f1);
        } else {
            (x3, f3) = (x2, f2);
            (x2, f2) = (x1, f1);
        }
        (x1, f1) = (x, f);
        let nearest = if f1.abs() < f2.abs() { x1 } else { x2 };
        if f1 == 0.0 || is_enough(f1.abs(), ((f1 - f2) / (x1 - x2)).abs()) {
            return x1;
        }
        let least = 2.0 * f64::EPSILON * nearest.abs() / (x2 - x1).abs();
        if !(least < 0.5) {
            return nearest;
        }
        let xi = (x1 - x2) / (x3 - x2);
        let phi = (f1 - f2) / (f3 - f2);
        part = if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
            f1 / (f2 - f1) * f3 / (f2 - f3)
                + (x3 - x1) / (x2 - x1) * f1 / (f3 - f1) * f2 / (f3 - f2)
        } else {
            0.5
        };
        part = if part > least {
            if part < 1.0 - least {
                part
            } else {
                1.0 - least
            }
        } else {
            least
        };
    }
    x1
}

#[cfg(test)]
mod tests {
    use super::{find_crossing, find_crossing_until, find_root};

    #[test]
    fn crossings_are_found_from_values_alone() {
        for (low, high, zero) in [(0.0, 2.0, 0.3), (-5.0, 1.0, 1e-9), (0.25, 0.375, 1.0 / 3.0)] {
            let mut evaluations = 0;
            let f = |x: f64| (x - zero) * (1.0 + x * x);
            let found = find_crossing(low, high, f(low), f(high), |x| {
                evaluations += 1;
                f(x)
            });
            assert!((found - zero).abs() <= 4.0 * f64::EPSILON * zero, "{found}");
            assert!(evaluations < 20, "{evaluations}");
        }
        // Only as near as it is asked for.
        let mut evaluations = 0;
        let near = find_crossing_until(
            [0.0, 2.0],
            [-0.3, 8.5],
            |x| {
                evaluations += 1;
                (x - 0.3) * (1.0 + x * x)
            },
            |value, slope| value <= 1e-6 * slope,
        );
        assert!(
            (near - 0.3).abs() < 2e-6 && evaluations < 8,
            "{near} {evaluations}"
        );
        // A jump, and values that are no numbers.
        let step = find_crossing(0.0, 1.0, -1.0, 1.0, |x| if x < 0.7 { -1.0 } else { 1.0 });
        assert!((step - 0.7).abs() < 1e-15);
        let wall = find_crossing(0.0, 1.0, -1.0, f64::INFINITY, |x| {
            if x < 0.7 { -1.0 } else { f64::INFINITY }
        });
        assert!((wall - 0.7).abs() < 1e-15);
        assert!((0.0..=1.0).contains(&find_crossing(0.0, 1.0, -1.0, 1.0, |_| f64::NAN)));
    }

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
