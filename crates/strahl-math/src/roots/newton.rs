use strahl_simd::{Isa, select};

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

/// The same for four functions side by side, each with the bits of its own search, in the `lanes` whose bits are set; their ends are 0 and 1.
///
/// `function` returns values and steps; `rising` has the bits of the functions that are negative at 0.
#[inline(always)]
pub fn newton_of_four<I: Isa>(
    isa: I,
    lanes: u32,
    rising: u32,
    guess: I::F64x4,
    mut function: impl FnMut(I::F64x4) -> (I::F64x4, I::F64x4),
) -> I::F64x4 {
    let [zero, one, half] = [0.0, 1.0, 0.5].map(|x| isa.splat(x));
    let smallest = isa.splat(SMALLEST);
    let (mut low, mut high) = (zero, one);
    let inside = isa.lt(zero, guess) & isa.lt(guess, one);
    let mut s = select(isa, inside, guess, half);
    // The sizes of the last steps, and the lanes in which they were Newton's.
    let (mut before, mut with_step) = (one, 0);
    let mut open = lanes;
    for _ in 0..200 {
        let (value, step) = function(s);
        open &= !(isa.le(value, zero) & isa.le(zero, value));
        if open == 0 {
            break;
        }
        let to_low = !(isa.lt(value, zero) ^ rising);
        low = select(isa, to_low, s, low);
        high = select(isa, to_low, high, s);
        let (next, size) = (isa.sub(s, step), isa.abs(step));
        let inside = isa.lt(low, next) & isa.lt(next, high);
        let steps = inside & (!with_step | isa.lt(size, isa.mul(half, before)));
        let part = select(isa, with_step, isa.div(size, before), one);
        let left = isa.mul(isa.mul(size, part), part);
        let tiny = isa.le(size, smallest);
        let middle = isa.mul(half, isa.add(low, high));
        let narrow = isa.le(middle, low) | isa.le(high, middle);
        let halves = !steps & !(tiny | narrow);
        s = select(isa, open & steps, next, s);
        s = select(isa, open & halves, middle, s);
        (before, with_step) = (select(isa, steps, size, before), steps);
        open &= halves | steps & !(tiny | isa.le(left, smallest));
        if open == 0 {
            break;
        }
    }
    s
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_simd::{Simd, dispatch};

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

    #[test]
    fn four_searches_are_those_of_one() {
        let mut state = 7u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        for round in 0..3000 {
            // Cubics with a root, and steps that are too long or not numbers.
            let roots: [f64; 4] = std::array::from_fn(|_| random().powi(1 + round % 5));
            let signs: [f64; 4] = std::array::from_fn(|_| if random() < 0.5 { -1.0 } else { 1.0 });
            let bend: [f64; 4] = std::array::from_fn(|_| 20.0 * random());
            let guess: [f64; 4] = std::array::from_fn(|_| 1.2 * random() - 0.1);
            let stretch = [1.0, 1.0, 3.0, f64::NAN][round as usize % 4];
            let rising = (0..4).fold(0, |all, k| all | u32::from(signs[k] > 0.0) << k);
            let expected: [f64; 4] = std::array::from_fn(|k| {
                newton(0.0, 1.0, signs[k] > 0.0, guess[k], |s| {
                    let aside = s - roots[k];
                    let value = signs[k] * aside * (1.0 + bend[k] * aside * aside);
                    let slope = signs[k] * (1.0 + 3.0 * bend[k] * aside * aside);
                    (value, value / slope * stretch)
                })
            });
            for simd in Simd::available() {
                let found = dispatch!(simd, isa => {
                    let [root, sign, bent] = [&roots, &signs, &bend].map(|v| isa.load(v));
                    let one = isa.splat(1.0);
                    isa.store(newton_of_four(isa, 0b1111, rising, isa.load(&guess), |s| {
                        let aside = isa.sub(s, root);
                        let square = |by| isa.mul(isa.mul(by, aside), aside);
                        let value = isa.mul(isa.mul(sign, aside), isa.add(one, square(bent)));
                        let three = isa.mul(isa.splat(3.0), bent);
                        let slope = isa.mul(sign, isa.add(one, square(three)));
                        (value, isa.mul(isa.div(value, slope), isa.splat(stretch)))
                    }))
                });
                assert_eq!(
                    found.map(f64::to_bits),
                    expected.map(f64::to_bits),
                    "{round} {simd:?}"
                );
            }
        }
    }
}
