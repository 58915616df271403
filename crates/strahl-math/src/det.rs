//! Elementary functions that give the same bits on every machine.
//!
//! The platform's libm differs between systems and picks FMA variants at run time; results that reach a pixel use these
//! software implementations instead: the `libm` crate, a port of musl's, and tables of our own for powers.

mod power;
mod sine;

pub use power::powers;
pub use sine::{sines, sines_and_cosines};

use strahl_simd::{Isa, Simd, dispatch};

/// Sine of `x` radians.
pub fn sin(x: f64) -> f64 {
    sine::sine(x)
}

/// Cosine of `x` radians.
pub fn cos(x: f64) -> f64 {
    sine::cosine(x)
}

/// Sine and cosine of `x` radians, with the bits of [`sin`] and [`cos`].
pub fn sin_cos(x: f64) -> (f64, f64) {
    sine::sine_and_cosine(x)
}

/// Tangent of `x` radians.
pub fn tan(x: f64) -> f64 {
    libm::tan(x)
}

/// Arc cosine in radians, `0..=pi`; NaN outside of `-1..=1`.
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}

/// Angle of the point `(x, y)` in radians, `-pi..=pi`.
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// `e` to the power of `x`.
pub fn exp(x: f64) -> f64 {
    power::exp(x)
}

/// Natural logarithm.
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// Arc sine in radians, `-pi/2..=pi/2`; NaN outside of `-1..=1`.
pub fn asin(x: f64) -> f64 {
    libm::asin(x)
}

/// Arc tangent in radians, `-pi/2..=pi/2`.
pub fn atan(x: f64) -> f64 {
    libm::atan(x)
}

/// Hyperbolic sine.
pub fn sinh(x: f64) -> f64 {
    libm::sinh(x)
}

/// Hyperbolic cosine.
pub fn cosh(x: f64) -> f64 {
    libm::cosh(x)
}

/// Hyperbolic tangent.
pub fn tanh(x: f64) -> f64 {
    libm::tanh(x)
}

/// Inverse hyperbolic sine.
pub fn asinh(x: f64) -> f64 {
    libm::asinh(x)
}

/// Inverse hyperbolic cosine; NaN below 1.
pub fn acosh(x: f64) -> f64 {
    // The library's formula cancels to a number for large negative arguments.
    if x < 1.0 { f64::NAN } else { libm::acosh(x) }
}

/// Inverse hyperbolic tangent; infinite at `-1` and `1`, NaN beyond them.
pub fn atanh(x: f64) -> f64 {
    libm::atanh(x)
}

/// Logarithm to base 10.
pub fn log10(x: f64) -> f64 {
    libm::log10(x)
}

/// `base` to the power of `exponent`.
///
/// Small whole exponents, the usual case of highlights, are computed by repeated squaring.
pub fn pow(base: f64, exponent: f64) -> f64 {
    small_power(base, exponent).unwrap_or_else(|| power::pow(base, exponent))
}

/// Raises all numbers to the power of one exponent, four at a time, with the bits of [`pow`].
pub fn pow_all(values: &mut [f64], exponent: f64) {
    let (fours, rest) = values.as_chunks_mut::<4>();
    dispatch!(Simd::best(), isa => {
        for four in fours {
            *four = powers(isa, four, exponent);
        }
    });
    for value in rest {
        *value = pow(*value, exponent);
    }
}

/// Replaces all angles, in radians, with their sines, four at a time, with the bits of [`sin`].
pub fn sin_all(angles: &mut [f64]) {
    let (fours, rest) = angles.as_chunks_mut::<4>();
    dispatch!(Simd::best(), isa => {
        for four in fours {
            *four = isa.store(sines(isa, isa.load(four)));
        }
    });
    for angle in rest {
        *angle = sin(*angle);
    }
}

/// Replaces all angles, in radians, with their cosines, four at a time, with the bits of [`cos`].
pub fn cos_all(angles: &mut [f64]) {
    let (fours, rest) = angles.as_chunks_mut::<4>();
    dispatch!(Simd::best(), isa => {
        for four in fours {
            let [_, cosines] = sines_and_cosines(isa, isa.load(four));
            *four = isa.store(cosines);
        }
    });
    for angle in rest {
        *angle = cos(*angle);
    }
}

/// An exponent that is a whole number from 0 to 64.
#[inline]
fn whole(exponent: f64) -> Option<u32> {
    let whole = exponent as u32;
    (f64::from(whole) == exponent && whole <= 64).then_some(whole)
}

/// Whole exponents from 0 to 64 by repeated squaring.
#[inline]
fn small_power(base: f64, exponent: f64) -> Option<f64> {
    Some(squared_again(base, whole(exponent)?))
}

/// A power by repeated squaring.
#[inline]
fn squared_again(base: f64, exponent: u32) -> f64 {
    let (mut result, mut square, mut bits) = (1.0, base, exponent);
    while bits > 0 {
        if bits & 1 == 1 {
            result *= square;
        }
        square *= square;
        bits >>= 1;
    }
    result
}

/// How powers with an exponent are found, for an exponent that is known before the bases are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponent(u8);

impl Exponent {
    /// Not a whole number from 0 to 64.
    const OTHER: u8 = u8::MAX;

    /// What is known of this exponent.
    pub fn new(exponent: f64) -> Self {
        Self(whole(exponent).map_or(Self::OTHER, |exponent| exponent as u8))
    }

    /// `base` to the power of the exponent given to [`Exponent::new`], with the bits of [`pow`].
    #[inline]
    pub fn of(self, base: f64, exponent: f64) -> f64 {
        match self.0 {
            Self::OTHER => power::pow(base, exponent),
            exponent => squared_again(base, exponent.into()),
        }
    }
}

/// Cube root.
pub fn cbrt(x: f64) -> f64 {
    libm::cbrt(x)
}

#[cfg(test)]
mod tests {
    #[test]
    fn powers_of_known_exponents_have_the_same_bits() {
        for exponent in [0.0, 1.0, 40.0, 64.0, 65.0, 0.025, -3.0, 2.5, f64::INFINITY] {
            let known = super::Exponent::new(exponent);
            for base in [0.0, 0.3, 1.0, 1.5, -2.0, 1e300, f64::NAN] {
                let (a, b) = (known.of(base, exponent), super::pow(base, exponent));
                assert!(a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan());
            }
        }
    }

    #[test]
    fn lists_of_angles_of_any_length_have_the_same_bits() {
        for count in 0..10 {
            let angles: Vec<f64> = (0..count).map(|k| f64::from(k) * 1.37 - 2.0).collect();
            let (mut sines, mut cosines) = (angles.clone(), angles.clone());
            super::sin_all(&mut sines);
            super::cos_all(&mut cosines);
            for (k, angle) in angles.into_iter().enumerate() {
                assert_eq!(sines[k].to_bits(), super::sin(angle).to_bits());
                assert_eq!(cosines[k].to_bits(), super::cos(angle).to_bits());
            }
        }
    }

    #[test]
    fn acosh_of_a_large_negative_number_is_nan() {
        assert!(super::acosh(-234504.77989254522).is_nan());
        assert_eq!(super::acosh(1.0), 0.0);
    }

    #[test]
    fn sine_and_cosine_together_have_the_same_bits() {
        let check = |x: f64| {
            let (sin, cos) = super::sin_cos(x);
            assert_eq!(sin.to_bits(), super::sin(x).to_bits(), "{x}");
            assert_eq!(cos.to_bits(), super::cos(x).to_bits(), "{x}");
        };
        for i in -20_000..20_000 {
            let x = f64::from(i);
            check(x * 0.000_37);
            check(x * 1.37e5);
            // Every exponent, around the limits where tiny angles are treated on their own.
            check(f64::from_bits((i as u64) << 47 & 0x7fff_ffff_ffff_ffff));
        }
        check(f64::NAN);
        check(f64::NEG_INFINITY);
    }

    #[test]
    fn whole_powers_agree_with_the_general_function() {
        for n in 0..=64 {
            let (a, b) = (
                super::pow(0.93, f64::from(n)),
                libm::pow(0.93, f64::from(n)),
            );
            assert!((a - b).abs() <= b * 1e-14, "{n}");
        }
        assert_eq!(super::pow(0.0, 0.0), 1.0);
        assert!((super::pow(0.5, 11.1434) - 0.000_442).abs() < 1e-6);
    }
}
