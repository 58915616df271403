//! Sines and cosines of one angle and of four at once, with the bits of the `libm` crate.
//!
//! Angles are reduced by the multiple of π/2 that is nearest to them (Cody and Waite 1980): π/2 is the sum of a number of 33 bits, whose
//! product with the multiple is exact, and a rest. The polynomials and constants are those of FreeBSD's msun, which `libm` is a port of.

#![allow(
    clippy::excessive_precision,
    clippy::unreadable_literal,
    clippy::approx_constant,
    reason = "the constants have the digits of msun"
)]

use strahl_simd::Isa;

/// Adding and subtracting it rounds to a whole number.
const ROUND: f64 = 1.5 / f64::EPSILON;
const TWO_BY_PI: f64 = 6.36619772367581382433e-01;
/// The first 33 bits of π/2.
const HALF_PI: f64 = 1.57079632673412561417e+00;
/// π/2 without them.
const HALF_PI_REST: f64 = 6.07710050650619224932e-11;
/// The next 33 bits of π/2, and what is left behind them.
const HALF_PI_NEXT: f64 = 6.07710050630396597660e-11;
const HALF_PI_NEXT_REST: f64 = 2.02226624879595063154e-21;
/// `libm` reduces angles below 9/4 π, which is less than this, in its own ways.
const SMALL: f64 = 8.0;
/// Larger angles it reduces with integers, from 2²⁰ π/2 = 1647099 on.
const LARGE: f64 = 1.64e6;

const SIN: [f64; 6] = [
    -1.66666666666666324348e-01,
    8.33333333332248946124e-03,
    -1.98412698298579493134e-04,
    2.75573137070700676789e-06,
    -2.50507602534068634195e-08,
    1.58969099521155010221e-10,
];
const COS: [f64; 6] = [
    4.16666666666666019037e-02,
    -1.38888888888741095749e-03,
    2.48015872894767294178e-05,
    -2.75573143513906633035e-07,
    2.08757232129817482790e-09,
    -1.13596475577881948265e-11,
];

/// Below this the angles are left to `libm`: the sine is the angle itself, and of zeros the sign counts.
const TINY: f64 = 1e-7;

/// An angle less the nearest multiple of π/2: `y + lost`.
struct Rest {
    y: f64,
    lost: f64,
    /// The multiple.
    quadrant: i32,
}

/// The rest of an angle, with the bits of the `libm` crate; `None` where it does something else: where angles are large ([`LARGE`]) or hardly more
/// than π/4, where they lie in the middle between two multiples (it may take the other one), and where they lie so close to a multiple that
/// bits are lost (16 of them). The bounds are a little narrower than its own.
#[inline(always)]
fn reduced(x: f64) -> Option<Rest> {
    let size = x.abs();
    if !(0.8..=LARGE).contains(&size) {
        return None;
    }
    let multiple = (x * TWO_BY_PI + ROUND) - ROUND;
    let exact = x - multiple * HALF_PI;
    let rest = multiple * HALF_PI_REST;
    let y = exact - rest;
    let lost = (exact - y) - rest;
    let part = y.abs();
    let quadrant = multiple as i32;
    (part <= 0.7853 && size * (1.0 / 8192.0) <= part).then_some(Rest { y, lost, quadrant })
}

impl Rest {
    #[inline(always)]
    fn sine(&self) -> f64 {
        let z = self.y * self.y;
        let w = z * z;
        let r = (SIN[1] + z * (SIN[2] + z * SIN[3])) + (z * w) * (SIN[4] + z * SIN[5]);
        let v = z * self.y;
        self.y - (((z * (0.5 * self.lost - v * r)) - self.lost) - v * SIN[0])
    }

    #[inline(always)]
    fn cosine(&self) -> f64 {
        small_cosine(self.y, self.lost)
    }

    /// `even` in even quadrants, `odd` in odd ones; negative in the second half of the four quadrants from `-turned` on.
    #[inline(always)]
    fn by_quadrant(&self, even: f64, odd: f64, turned: i32) -> f64 {
        let value = if self.quadrant & 1 == 0 { even } else { odd };
        if (self.quadrant + turned) & 2 == 0 {
            value
        } else {
            -value
        }
    }
}

/// Whether an angle is so small that it is not reduced.
#[inline(always)]
fn is_small(x: f64) -> bool {
    (TINY..=0.785).contains(&x.abs())
}

/// The sine of a [small](is_small) angle.
#[inline(always)]
fn small_sine(x: f64) -> f64 {
    let z = x * x;
    let w = z * z;
    let r = (SIN[1] + z * (SIN[2] + z * SIN[3])) + (z * w) * (SIN[4] + z * SIN[5]);
    x + (z * x) * (SIN[0] + z * r)
}

/// The cosine of `y + lost`, a small angle.
#[inline(always)]
fn small_cosine(y: f64, lost: f64) -> f64 {
    let z = y * y;
    let w = z * z;
    let low = z * (COS[0] + z * (COS[1] + z * COS[2]));
    let high = (w * w) * (COS[3] + z * (COS[4] + z * COS[5]));
    let half = 0.5 * z;
    let w = 1.0 - half;
    w + (((1.0 - w) - half) + (z * (low + high) - y * lost))
}

/// The sine of an angle in radians, with the bits of the `libm` crate.
#[inline(always)]
pub(super) fn sine(x: f64) -> f64 {
    if is_small(x) {
        return small_sine(x);
    }
    reduced(x).map_or_else(
        || libm::sin(x),
        |rest| {
            let is_even = rest.quadrant & 1 == 0;
            let value = if is_even { rest.sine() } else { rest.cosine() };
            if rest.quadrant & 2 == 0 {
                value
            } else {
                -value
            }
        },
    )
}

/// The cosine of an angle in radians, with the bits of the `libm` crate.
#[inline(always)]
pub(super) fn cosine(x: f64) -> f64 {
    if is_small(x) {
        return small_cosine(x, 0.0);
    }
    reduced(x).map_or_else(
        || libm::cos(x),
        |rest| {
            let is_even = rest.quadrant & 1 == 0;
            let value = if is_even { rest.cosine() } else { rest.sine() };
            if (rest.quadrant + 1) & 2 == 0 {
                value
            } else {
                -value
            }
        },
    )
}

/// The sine and the cosine of an angle in radians, with the bits of [`sine`] and [`cosine`].
#[inline(always)]
pub(super) fn sine_and_cosine(x: f64) -> (f64, f64) {
    if is_small(x) {
        return (small_sine(x), small_cosine(x, 0.0));
    }
    reduced(x).map_or_else(
        || libm::sincos(x),
        |rest| {
            let (sin, cos) = (rest.sine(), rest.cosine());
            (rest.by_quadrant(sin, cos, 0), rest.by_quadrant(cos, sin, 1))
        },
    )
}

/// The sines of four angles in radians, each with the bits of [`super::sin`].
#[inline(always)]
pub fn sines<I: Isa>(isa: I, x: I::F64x4) -> I::F64x4 {
    let reduced = Reduced::new(isa, x);
    reduced.corrected(isa, x, reduced.sines(isa), libm::sin)
}

/// The sines and the cosines of four angles in radians, each with the bits of [`super::sin_cos`].
#[inline(always)]
pub fn sines_and_cosines<I: Isa>(isa: I, x: I::F64x4) -> [I::F64x4; 2] {
    let reduced = Reduced::new(isa, x);
    [
        reduced.corrected(isa, x, reduced.sines(isa), libm::sin),
        reduced.corrected(isa, x, reduced.cosines(isa), libm::cos),
    ]
}

/// Four angles, reduced by multiples of π/2.
struct Reduced<V> {
    /// The quadrants, from -2 to 2; -2 and 2 are the same.
    quadrant: V,
    /// The sines and cosines of what is left.
    sin: V,
    cos: V,
    /// The lanes in which they have the bits of `libm`.
    usual: u32,
}

impl<V: Copy> Reduced<V> {
    #[inline(always)]
    fn new<I: Isa<F64x4 = V>>(isa: I, x: V) -> Self {
        let n = |number: f64| isa.splat(number);
        let multiple = isa.sub(isa.add(isa.mul(x, n(TWO_BY_PI)), n(ROUND)), n(ROUND));
        let exact = isa.sub(x, isa.mul(multiple, n(HALF_PI)));
        let rest = isa.mul(multiple, n(HALF_PI_REST));
        let mut y = isa.sub(exact, rest);
        let mut lost = isa.sub(isa.sub(exact, y), rest);
        let mut precise = isa.le(isa.mul(isa.abs(x), n(1.0 / 8192.0)), isa.abs(y));
        if precise != 0b1111 {
            precise |= refine(isa, x, multiple, exact, &mut y, &mut lost);
        }
        let turns = isa.sub(isa.add(isa.mul(multiple, n(0.25)), n(ROUND)), n(ROUND));
        let (size, part) = (isa.abs(x), isa.abs(y));
        Self {
            quadrant: isa.sub(multiple, isa.mul(turns, n(4.0))),
            sin: sin_near_zero(isa, y, lost),
            cos: cos_near_zero(isa, y, lost),
            // The bounds are those of `sine`.
            usual: isa.le(n(0.8), size)
                & isa.le(size, n(LARGE))
                & isa.le(part, n(0.7853))
                & precise,
        }
    }

    /// `odd` in the quadrants -1 and 1, `even` in the others.
    #[inline(always)]
    fn by_parity<I: Isa<F64x4 = V>>(&self, isa: I, even: V, odd: V) -> V {
        let from_one = isa.abs(isa.sub(isa.abs(self.quadrant), isa.splat(1.0)));
        isa.choose_le(from_one, isa.splat(0.5), odd, even)
    }

    #[inline(always)]
    fn sines<I: Isa<F64x4 = V>>(&self, isa: I) -> V {
        let value = self.by_parity(isa, self.sin, self.cos);
        // Negative in the quadrants -2, -1 and 2.
        let negative = isa.mul(value, isa.splat(-1.0));
        let value = isa.choose_le(self.quadrant, isa.splat(-0.5), negative, value);
        isa.choose_le(isa.splat(1.5), self.quadrant, negative, value)
    }

    #[inline(always)]
    fn cosines<I: Isa<F64x4 = V>>(&self, isa: I) -> V {
        let value = self.by_parity(isa, self.cos, self.sin);
        // Negative in the quadrants -2, 1 and 2.
        let negative = isa.mul(value, isa.splat(-1.0));
        let value = isa.choose_le(self.quadrant, isa.splat(-1.5), negative, value);
        isa.choose_le(isa.splat(0.5), self.quadrant, negative, value)
    }

    /// The values with those that another function gives where they may have other bits.
    #[inline(always)]
    fn corrected<I: Isa<F64x4 = V>>(&self, isa: I, x: V, values: V, f: fn(f64) -> f64) -> V {
        if self.usual == 0b1111 {
            return values;
        }
        let (angles, mut values) = (isa.store(x), isa.store(values));
        for lane in 0..4 {
            if self.usual >> lane & 1 == 0 {
                values[lane] = f(angles[lane]);
            }
        }
        isa.load(&values)
    }
}

/// Subtracts the multiple of π/2 with 33 bits more where `libm` does so: where more than 16 bits were lost (the exponents of the angle and of
/// the difference tell). Returns the lanes that have the bits of `libm` now.
#[inline(always)]
fn refine<I: Isa>(
    isa: I,
    x: I::F64x4,
    multiple: I::F64x4,
    exact: I::F64x4,
    y: &mut I::F64x4,
    lost: &mut I::F64x4,
) -> u32 {
    let n = |number: f64| isa.splat(number);
    let next = isa.mul(multiple, n(HALF_PI_NEXT));
    let difference = isa.sub(exact, next);
    let rest = isa.sub(
        isa.mul(multiple, n(HALF_PI_NEXT_REST)),
        isa.sub(isa.sub(exact, difference), next),
    );
    let finer = isa.sub(difference, rest);
    let finer_lost = isa.sub(isa.sub(difference, finer), rest);
    // With 49 bits lost `libm` goes on.
    let far = 1.0 / (1u64 << 47) as f64;
    let is_precise =
        isa.lt(n(SMALL), isa.abs(x)) & isa.le(isa.mul(isa.abs(x), n(far)), isa.abs(finer));
    let angles = isa.store(x);
    let (mut values, mut rests) = (isa.store(*y), isa.store(*lost));
    let (finer, finer_lost) = (isa.store(finer), isa.store(finer_lost));
    for lane in 0..4 {
        if exponent(angles[lane]) > exponent(values[lane]) + 16 {
            (values[lane], rests[lane]) = (finer[lane], finer_lost[lane]);
        }
    }
    (*y, *lost) = (isa.load(&values), isa.load(&rests));
    is_precise
}

/// The exponent as it is stored.
#[inline(always)]
fn exponent(x: f64) -> u64 {
    x.to_bits() >> 52 & 0x7ff
}

/// The sine of `y + lost`, `|y|` at most π/4.
#[inline(always)]
fn sin_near_zero<I: Isa>(isa: I, y: I::F64x4, lost: I::F64x4) -> I::F64x4 {
    let n = |number: f64| isa.splat(number);
    let z = isa.mul(y, y);
    let w = isa.mul(z, z);
    let high = isa.mul(isa.mul(z, w), isa.add(n(SIN[4]), isa.mul(z, n(SIN[5]))));
    let low = isa.mul(z, isa.add(n(SIN[2]), isa.mul(z, n(SIN[3]))));
    let r = isa.add(isa.add(n(SIN[1]), low), high);
    let v = isa.mul(z, y);
    let inner = isa.sub(isa.mul(n(0.5), lost), isa.mul(v, r));
    let inner = isa.sub(isa.mul(z, inner), lost);
    isa.sub(y, isa.sub(inner, isa.mul(v, n(SIN[0]))))
}

/// The cosine of `y + lost`, `|y|` at most π/4.
#[inline(always)]
fn cos_near_zero<I: Isa>(isa: I, y: I::F64x4, lost: I::F64x4) -> I::F64x4 {
    let n = |number: f64| isa.splat(number);
    let z = isa.mul(y, y);
    let w = isa.mul(z, z);
    let low = isa.add(n(COS[1]), isa.mul(z, n(COS[2])));
    let low = isa.mul(z, isa.add(n(COS[0]), isa.mul(z, low)));
    let high = isa.add(n(COS[4]), isa.mul(z, n(COS[5])));
    let high = isa.add(n(COS[3]), isa.mul(z, high));
    let high = isa.mul(isa.mul(w, w), high);
    let r = isa.add(low, high);
    let half = isa.mul(n(0.5), z);
    let w = isa.sub(n(1.0), half);
    let rounded = isa.sub(isa.sub(n(1.0), w), half);
    let small = isa.sub(isa.mul(z, r), isa.mul(y, lost));
    isa.add(w, isa.add(rounded, small))
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_simd::{Simd, dispatch};

    fn four(simd: Simd, x: [f64; 4]) -> [f64; 4] {
        dispatch!(simd, isa => isa.store(sines(isa, isa.load(&x))))
    }

    fn four_pairs(simd: Simd, x: [f64; 4]) -> [[f64; 4]; 2] {
        dispatch!(simd, isa => {
            let [sin, cos] = sines_and_cosines(isa, isa.load(&x));
            [isa.store(sin), isa.store(cos)]
        })
    }

    #[test]
    fn sines_have_the_bits_of_libm() {
        let mut angles = vec![0.0, -0.0, 1e-300, 1e7, -1e22, f64::INFINITY, f64::NAN];
        // Around the multiples of an eighth of a turn, where quadrants change and bits are lost.
        for eighth in -40..=40 {
            let angle = f64::from(eighth) * std::f64::consts::FRAC_PI_4;
            for power in 8..56 {
                let near = 1.0 + (-f64::from(power)).exp2();
                angles.extend([angle, angle * near, angle / near]);
            }
        }
        let mut state = 1u64;
        for n in 0..40_000 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let unit = (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5;
            angles.push(unit * f64::from(1 << (n % 24)));
        }
        // Where more bits are lost, the more the larger the angle is.
        for n in 0..40_000 {
            let large = 1.7e6 * f64::from(n) / 40_000.0;
            let multiple = (large * TWO_BY_PI).round() * std::f64::consts::FRAC_PI_2;
            angles.extend([
                large,
                -large,
                multiple,
                multiple + large * 1e-9,
                multiple - 1e-5,
            ]);
        }
        for simd in Simd::available() {
            for four_angles in angles.chunks(4) {
                let mut x = [0.7; 4];
                x[..four_angles.len()].copy_from_slice(four_angles);
                let [sines, cosines] = four_pairs(simd, x);
                for (k, angle) in x.into_iter().enumerate() {
                    let expected = libm::sincos(angle);
                    for (value, expected) in [(sines[k], expected.0), (cosines[k], expected.1)] {
                        let is_same = value.to_bits() == expected.to_bits()
                            || value.is_nan() && expected.is_nan();
                        assert!(is_same, "{angle}: {value} and not {expected} ({simd:?})");
                    }
                }
                for (angle, sine) in x.into_iter().zip(four(simd, x)) {
                    let (expected, expected_cosine) = (libm::sincos(angle), libm::cos(angle));
                    let (sin, cos) = sine_and_cosine(angle);
                    for (value, expected) in [
                        (cosine(angle), expected_cosine),
                        (cos, expected_cosine),
                        (sin, expected.0),
                    ] {
                        let is_same = value.to_bits() == expected.to_bits()
                            || value.is_nan() && expected.is_nan();
                        assert!(is_same, "{angle}: {value} and not {expected}");
                    }
                    let expected = libm::sin(angle);
                    for sine in [sine, super::sine(angle)] {
                        let is_same = sine.to_bits() == expected.to_bits()
                            || sine.is_nan() && expected.is_nan();
                        assert!(is_same, "sin {angle}: {sine} and not {expected} ({simd:?})");
                    }
                }
            }
        }
    }
}
