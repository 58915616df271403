//! Powers, exponentials and logarithms from tables.
//!
//! The method is that of Tang (ACM TOMS 1989 and 1990) as refined by Nagy for ARM's Optimized Routines (2018), for processors
//! without fused multiply-adds: a table of 128 entries reduces the argument to a number near 1 (or 0), then a short polynomial is
//! evaluated, and powers use the logarithm in two doubles. Results are within one unit in the last place. Rare cases (zeros,
//! negative numbers, infinities, results near overflow) are left to the `libm` crate.

mod tables;

use strahl_simd::Isa;
use tables::{EXP, LOG};

/// The beginning of the logarithm's table, slightly below 0.71, so that 1 lies inside an interval.
const START: u64 = 0x3fe6_9555_0000_0000;
/// ln 2 in two parts; the first ends with zero bits, so that its products with exponents are exact.
const LN_2: [f64; 2] = [0.6931471805598903, 5.497923018708371e-14];
/// ln 2 / 128 in two parts, and 128 / ln 2.
const STEP: [f64; 2] = [0.005415212348111709, 1.2864023111638346e-14];
const STEPS: f64 = 184.6649652337873;
/// Adding and subtracting 1.5 * 2^52 rounds to an integer.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// `e` to the power of this is less than half of the smallest number above zero, which is rounded to zero.
const NOTHING: f64 = -746.0;

/// Whether a number is positive, finite and not subnormal.
#[inline]
fn is_usual(x: f64) -> bool {
    let bits = x.to_bits();
    bits.wrapping_sub(0x0010_0000_0000_0000) < 0x7ff0_0000_0000_0000 - 0x0010_0000_0000_0000
}

/// The natural logarithm of a usual number as the sum of two; the second is small against the first.
#[inline]
fn ln_parts(x: f64) -> (f64, f64) {
    let bits = x.to_bits();
    let above = bits.wrapping_sub(START);
    let [inverse, log_high, log_low] = LOG[(above >> 45 & 127) as usize];
    let exponent = (above as i64 >> 52) as f64;
    let mantissa = bits.wrapping_sub(above & (0xfff << 52));
    let z = f64::from_bits(mantissa);
    // z / c - 1 in two parts, both exact: 1 / c has nine bits, the upper part of z twenty-one.
    let z_high = f64::from_bits(mantissa.wrapping_add(1 << 31) & !0xffff_ffff);
    let r_high = z_high * inverse - 1.0;
    let r_low = (z - z_high) * inverse;
    let r = r_high + r_low;
    let t1 = exponent * LN_2[0] + log_high;
    let t2 = t1 + r;
    let low1 = exponent * LN_2[1] + log_low;
    let low2 = t1 - t2 + r;
    // ln(1 + r) = r - r^2 / 2 + ...; the square of the upper part is exact.
    let half = -0.5 * r;
    let half_high = -0.5 * r_high;
    let square_high = r_high * half_high;
    let high = t2 + square_high;
    let low3 = r_low * (half + half_high);
    let low4 = t2 - high + square_high;
    let r2 = r * r;
    let polynomial =
        (1.0 / 3.0 - r * 0.25) + r2 * ((0.2 - r * (1.0 / 6.0)) + r2 * (1.0 / 7.0 - r * 0.125));
    let low = low1 + low2 + low3 + low4 + r2 * r * polynomial;
    let sum = high + low;
    (sum, high - sum + low)
}

/// `e^(x + low)` for |x| below 700 and a small `low`.
#[inline]
fn exp_parts(x: f64, low: f64) -> f64 {
    let rounded = x * STEPS + ROUND;
    let number = rounded.to_bits();
    let steps = rounded - ROUND;
    let r = x - steps * STEP[0] - steps * STEP[1] + low;
    let (scale, tail) = EXP[(number & 127) as usize];
    // The number of the step, without its last seven bits, is the exponent of the power of two.
    let scale = f64::from_bits(scale.wrapping_add((number & !127) << 45));
    let r2 = r * r;
    let change =
        tail + r + r2 * (0.5 + r * (1.0 / 6.0)) + r2 * r2 * (1.0 / 24.0 + r * (1.0 / 120.0));
    scale + scale * change
}

/// `e` to the power of `x`.
#[inline]
pub(super) fn exp(x: f64) -> f64 {
    if x > -700.0 && x < 700.0 {
        exp_parts(x, 0.0)
    } else {
        libm::exp(x)
    }
}

/// `base` to the power of `exponent`.
#[inline]
pub(super) fn pow(base: f64, exponent: f64) -> f64 {
    if !is_usual(base) || !exponent.is_finite() {
        return libm::pow(base, exponent);
    }
    let (high, low) = ln_parts(base);
    // The product of logarithm and exponent, in two parts (Dekker 1971).
    let (e, l) = (upper(exponent), upper(high));
    let product = e * l;
    let rest = (exponent - e) * l + exponent * (high - l + low);
    if !(product > -700.0 && product < 700.0) {
        // Highlights of small lights: most of their powers are less than half of the smallest number.
        if product < NOTHING {
            return 0.0;
        }
        return libm::pow(base, exponent);
    }
    exp_parts(product, rest)
}

/// Four bases to the power of one exponent, each with the bits of [`super::pow`].
#[inline(always)]
pub fn powers<I: Isa>(isa: I, bases: &[f64; 4], exponent: f64) -> [f64; 4] {
    let n = |number: f64| isa.splat(number);
    let mut usual = exponent.is_finite() && super::whole(exponent).is_none();
    for base in bases {
        usual &= is_usual(*base);
    }
    if !usual {
        return each(bases, exponent);
    }
    // As `ln_parts`: what concerns bits lane by lane, the rest in vectors.
    let (mut inverse, mut log_high, mut log_low) = ([0.0; 4], [0.0; 4], [0.0; 4]);
    let (mut exponents, mut z, mut z_high) = ([0.0; 4], [0.0; 4], [0.0; 4]);
    for lane in 0..4 {
        let bits = bases[lane].to_bits();
        let above = bits.wrapping_sub(START);
        [inverse[lane], log_high[lane], log_low[lane]] = LOG[(above >> 45 & 127) as usize];
        exponents[lane] = (above as i64 >> 52) as f64;
        let mantissa = bits.wrapping_sub(above & (0xfff << 52));
        z[lane] = f64::from_bits(mantissa);
        z_high[lane] = f64::from_bits(mantissa.wrapping_add(1 << 31) & !0xffff_ffff);
    }
    let (inverse, z_high) = (isa.load(&inverse), isa.load(&z_high));
    let (exponents, log_high) = (isa.load(&exponents), isa.load(&log_high));
    let r_high = isa.sub(isa.mul(z_high, inverse), n(1.0));
    let r_low = isa.mul(isa.sub(isa.load(&z), z_high), inverse);
    let r = isa.add(r_high, r_low);
    let t1 = isa.add(isa.mul(exponents, n(LN_2[0])), log_high);
    let t2 = isa.add(t1, r);
    let low1 = isa.add(isa.mul(exponents, n(LN_2[1])), isa.load(&log_low));
    let low2 = isa.add(isa.sub(t1, t2), r);
    let half = isa.mul(n(-0.5), r);
    let half_high = isa.mul(n(-0.5), r_high);
    let square_high = isa.mul(r_high, half_high);
    let high = isa.add(t2, square_high);
    let low3 = isa.mul(r_low, isa.add(half, half_high));
    let low4 = isa.add(isa.sub(t2, high), square_high);
    let r2 = isa.mul(r, r);
    let first = isa.sub(n(1.0 / 3.0), isa.mul(r, n(0.25)));
    let second = isa.sub(n(0.2), isa.mul(r, n(1.0 / 6.0)));
    let third = isa.sub(n(1.0 / 7.0), isa.mul(r, n(0.125)));
    let polynomial = isa.add(first, isa.mul(r2, isa.add(second, isa.mul(r2, third))));
    let low = isa.add(
        isa.add(isa.add(isa.add(low1, low2), low3), low4),
        isa.mul(isa.mul(r2, r), polynomial),
    );
    let sum = isa.add(high, low);
    let rest = isa.add(isa.sub(high, sum), low);
    // The product of logarithm and exponent.
    let e = upper(exponent);
    let mut sums = isa.store(sum);
    for sum in &mut sums {
        *sum = upper(*sum);
    }
    let l = isa.load(&sums);
    let product = isa.mul(n(e), l);
    let rest = isa.add(
        isa.mul(n(exponent - e), l),
        isa.mul(n(exponent), isa.add(isa.sub(sum, l), rest)),
    );
    if isa.lt(n(-700.0), product) & isa.lt(product, n(700.0)) != 0b1111 {
        return each(bases, exponent);
    }
    // As `exp_parts`.
    let rounded = isa.add(isa.mul(product, n(STEPS)), n(ROUND));
    let steps = isa.sub(rounded, n(ROUND));
    let r = isa.sub(
        isa.sub(product, isa.mul(steps, n(STEP[0]))),
        isa.mul(steps, n(STEP[1])),
    );
    let r = isa.add(r, rest);
    let rounded = isa.store(rounded);
    let (mut scales, mut tails) = ([0.0; 4], [0.0; 4]);
    for lane in 0..4 {
        let number = rounded[lane].to_bits();
        let (scale, tail) = EXP[(number & 127) as usize];
        scales[lane] = f64::from_bits(scale.wrapping_add((number & !127) << 45));
        tails[lane] = tail;
    }
    let scale = isa.load(&scales);
    let r2 = isa.mul(r, r);
    let quadratic = isa.mul(r2, isa.add(n(0.5), isa.mul(r, n(1.0 / 6.0))));
    let quartic = isa.mul(
        isa.mul(r2, r2),
        isa.add(n(1.0 / 24.0), isa.mul(r, n(1.0 / 120.0))),
    );
    let change = isa.add(isa.add(isa.add(isa.load(&tails), r), quadratic), quartic);
    isa.store(isa.add(scale, isa.mul(scale, change)))
}

/// Powers one by one.
#[inline(never)]
fn each(bases: &[f64; 4], exponent: f64) -> [f64; 4] {
    bases.map(|base| super::pow(base, exponent))
}

/// A number without its last 27 bits: products of two such numbers are exact.
#[inline(always)]
fn upper(v: f64) -> f64 {
    f64::from_bits(v.to_bits() & !0x07ff_ffff)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use strahl_simd::{Simd, dispatch};

    /// The number of doubles between two numbers.
    fn apart(a: f64, b: f64) -> u64 {
        a.to_bits().abs_diff(b.to_bits())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn powers_are_right_to_the_last_place(base in 1e-6..1e3f64, exponent in -90.0..90.0f64) {
            prop_assert!(apart(pow(base, exponent), libm::pow(base, exponent)) <= 1);
        }

        #[test]
        fn powers_of_numbers_near_one_are_right(difference in -1e-3..1e-3f64, exponent in -1e5..1e5f64) {
            let base = 1.0 + difference;
            prop_assert!(apart(pow(base, exponent), libm::pow(base, exponent)) <= 1);
        }

        #[test]
        fn exponentials_are_right_to_the_last_place(x in -705.0..705.0f64) {
            prop_assert!(apart(exp(x), libm::exp(x)) <= 1);
        }

        #[test]
        fn any_bits_give_what_the_library_gives(base in any::<u64>(), exponent in any::<u64>()) {
            let (base, exponent) = (f64::from_bits(base), f64::from_bits(exponent));
            let (a, b) = (pow(base, exponent), libm::pow(base, exponent));
            prop_assert!((a.is_nan() && b.is_nan()) || apart(a, b) <= 1, "{base} {exponent}: {a} {b}");
        }
    }

    fn four(simd: Simd, bases: [f64; 4], exponent: f64) -> [u64; 4] {
        dispatch!(simd, isa => powers(isa, &bases, exponent)).map(f64::to_bits)
    }

    #[test]
    fn four_powers_have_the_bits_of_single_ones() {
        let special = [0.0, -1.0, f64::INFINITY, f64::NAN, 1e-310];
        let exponents = [2.4, 1.0 / 2.2, 40.0, 0.0, -3.7, 1e5, 123.5, f64::NAN];
        for simd in Simd::available() {
            for step in 0..4000 {
                let base = |lane: i32| 1.003f64.powi(step - 2000) * (1.0 + 0.1 * f64::from(lane));
                let mut bases = [0, 1, 2, 3].map(base);
                if step % 50 == 0 {
                    bases[step as usize / 50 % 4] = special[step as usize / 50 % 5];
                }
                for exponent in exponents {
                    let single = bases.map(|base| crate::det::pow(base, exponent).to_bits());
                    assert_eq!(
                        four(simd, bases, exponent),
                        single,
                        "{bases:?} {exponent} {}",
                        simd.level()
                    );
                }
            }
        }
    }

    #[test]
    fn special_cases_are_those_of_the_library() {
        let all = [
            0.0,
            -0.0,
            1.0,
            -1.0,
            2.0,
            -2.0,
            0.5,
            3.0,
            1e-310,
            1e300,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NAN,
            1024.0,
            -1075.0,
        ];
        for base in all {
            for exponent in all {
                let (a, b) = (pow(base, exponent), libm::pow(base, exponent));
                assert!(
                    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan(),
                    "{base} {exponent}"
                );
            }
            let (a, b) = (exp(base), libm::exp(base));
            assert!(apart(a, b) <= 1 || a.is_nan() && b.is_nan(), "{base}");
        }
    }
}
