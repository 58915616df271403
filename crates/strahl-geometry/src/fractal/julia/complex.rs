//! Complex functions with their derivatives, by the deterministic functions of real numbers.

use super::real::Real;
use std::ops::{Add, Mul, Neg, Sub};
use strahl_math::det;

/// A complex number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Complex<R = f64> {
    pub(super) re: R,
    pub(super) im: R,
}

/// 1
const ONE: Complex = Complex::new(1.0, 0.0);

impl<R> Complex<R> {
    pub(super) const fn new(re: R, im: R) -> Self {
        Self { re, im }
    }
}

impl<R: Real> Complex<R> {
    #[inline(always)]
    pub(super) fn square(self) -> Self {
        Self::new(
            (self.re - self.im) * (self.re + self.im),
            self.re.like(2.0) * self.re * self.im,
        )
    }

    #[inline(always)]
    pub(super) fn norm2(self) -> R {
        self.re * self.re + self.im * self.im
    }
}

impl Complex {
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self::new(self.re * factor, self.im * factor)
    }

    pub(super) fn conjugate(self) -> Self {
        Self::new(self.re, -self.im)
    }

    pub(super) fn inverse(self) -> Self {
        self.conjugate().scaled(1.0 / self.norm2())
    }

    fn over(self, other: Self) -> Self {
        self * other.inverse()
    }

    /// Times the imaginary unit.
    fn turned(self) -> Self {
        Self::new(-self.im, self.re)
    }

    pub(super) fn exp(self) -> Self {
        let r = det::exp(self.re);
        let (sin, cos) = det::sin_cos(self.im);
        Self::new(r * cos, r * sin)
    }

    /// The principal value.
    pub(super) fn ln(self) -> Self {
        Self::new(0.5 * det::ln(self.norm2()), det::atan2(self.im, self.re))
    }

    /// The root with a real part that is not negative.
    pub(super) fn sqrt(self) -> Self {
        let r = self.norm2().sqrt();
        let re = (0.5 * (r + self.re)).max(0.0).sqrt();
        let im = (0.5 * (r - self.re)).max(0.0).sqrt();
        Self::new(re, if self.im < 0.0 { -im } else { im })
    }

    pub(super) fn sin(self) -> Self {
        let (sin, cos) = det::sin_cos(self.re);
        Self::new(sin * det::cosh(self.im), cos * det::sinh(self.im))
    }

    pub(super) fn cos(self) -> Self {
        let (sin, cos) = det::sin_cos(self.re);
        Self::new(cos * det::cosh(self.im), -(sin * det::sinh(self.im)))
    }

    pub(super) fn sinh(self) -> Self {
        // sinh z = -i sin(i z)
        let s = self.turned().sin();
        Self::new(s.im, -s.re)
    }

    pub(super) fn cosh(self) -> Self {
        self.turned().cos()
    }

    pub(super) fn tan(self) -> Self {
        self.sin().over(self.cos())
    }

    pub(super) fn tanh(self) -> Self {
        self.sinh().over(self.cosh())
    }

    pub(super) fn asinh(self) -> Self {
        (self + (self.square() + ONE).sqrt()).ln()
    }

    pub(super) fn asin(self) -> Self {
        // asin z = -i asinh(i z)
        let s = self.turned().asinh();
        Self::new(s.im, -s.re)
    }

    pub(super) fn acos(self) -> Self {
        Self::new(std::f64::consts::FRAC_PI_2, 0.0) - self.asin()
    }

    pub(super) fn acosh(self) -> Self {
        (self + (self + ONE).sqrt() * (self - ONE).sqrt()).ln()
    }

    pub(super) fn atanh(self) -> Self {
        ((ONE + self).ln() - (ONE - self).ln()).scaled(0.5)
    }

    pub(super) fn atan(self) -> Self {
        // atan z = -i atanh(i z)
        let s = self.turned().atanh();
        Self::new(s.im, -s.re)
    }

    /// To a complex power, by the principal logarithm.
    pub(super) fn pow(self, exponent: Self) -> Self {
        (self.ln() * exponent).exp()
    }
}

impl<R: Real> Add for Complex<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }
}

impl Sub for Complex {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }
}

impl<R: Real> Mul for Complex<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::new(
            self.re * other.re - self.im * other.im,
            self.re * other.im + self.im * other.re,
        )
    }
}

impl Neg for Complex {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.re, -self.im)
    }
}

/// A function of hypercomplex numbers, given by that of complex numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HypercomplexFunction {
    /// `h * h`
    Square,
    /// `h * h * h`
    Cube,
    /// The exponential.
    Exp,
    /// `1 / h`
    Reciprocal,
    /// The sine.
    Sin,
    /// The arc sine.
    Asin,
    /// The hyperbolic sine.
    Sinh,
    /// The inverse hyperbolic sine.
    Asinh,
    /// The cosine.
    Cos,
    /// The arc cosine.
    Acos,
    /// The hyperbolic cosine.
    Cosh,
    /// The inverse hyperbolic cosine.
    Acosh,
    /// The tangent.
    Tan,
    /// The arc tangent.
    Atan,
    /// The hyperbolic tangent.
    Tanh,
    /// The inverse hyperbolic tangent.
    Atanh,
    /// The natural logarithm.
    Ln,
    /// The power with this complex exponent.
    Power(f64, f64),
}

impl HypercomplexFunction {
    /// The value at `z`.
    pub(super) fn value(self, z: Complex) -> Complex {
        match self {
            Self::Square => z.square(),
            Self::Cube => z.square() * z,
            Self::Exp => z.exp(),
            Self::Reciprocal => z.inverse(),
            Self::Sin => z.sin(),
            Self::Asin => z.asin(),
            Self::Sinh => z.sinh(),
            Self::Asinh => z.asinh(),
            Self::Cos => z.cos(),
            Self::Acos => z.acos(),
            Self::Cosh => z.cosh(),
            Self::Acosh => z.acosh(),
            Self::Tan => z.tan(),
            Self::Atan => z.atan(),
            Self::Tanh => z.tanh(),
            Self::Atanh => z.atanh(),
            Self::Ln => z.ln(),
            Self::Power(re, im) => z.pow(Complex::new(re, im)),
        }
    }

    /// The derivative at `z`, where the function has this value.
    pub(super) fn slope(self, z: Complex, value: Complex) -> Complex {
        match self {
            Self::Square => z.scaled(2.0),
            Self::Cube => z.square().scaled(3.0),
            Self::Exp => value,
            Self::Reciprocal => -value.square(),
            Self::Sin => z.cos(),
            Self::Cos => -z.sin(),
            Self::Sinh => z.cosh(),
            Self::Cosh => z.sinh(),
            Self::Tan => ONE + value.square(),
            Self::Tanh => ONE - value.square(),
            Self::Asin => (ONE - z.square()).sqrt().inverse(),
            Self::Acos => -(ONE - z.square()).sqrt().inverse(),
            Self::Asinh => (z.square() + ONE).sqrt().inverse(),
            Self::Acosh => ((z + ONE).sqrt() * (z - ONE).sqrt()).inverse(),
            Self::Atan => (ONE + z.square()).inverse(),
            Self::Atanh => (ONE - z.square()).inverse(),
            Self::Ln => z.inverse(),
            Self::Power(re, im) => (value * Complex::new(re, im)).over(z),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [HypercomplexFunction; 18] = {
        use HypercomplexFunction::*;
        [
            Square,
            Cube,
            Exp,
            Reciprocal,
            Sin,
            Asin,
            Sinh,
            Asinh,
            Cos,
            Acos,
            Cosh,
            Acosh,
            Tan,
            Atan,
            Tanh,
            Atanh,
            Ln,
            Power(1.5, -0.5),
        ]
    };

    #[test]
    fn derivatives_are_differences() {
        for f in ALL {
            for z in [
                Complex::new(0.3, 0.4),
                Complex::new(-0.7, 0.2),
                Complex::new(0.9, -1.3),
            ] {
                let step = 1e-5;
                for direction in [ONE, Complex::new(0.0, 1.0)] {
                    let d = direction.scaled(step);
                    let difference = (f.value(z + d) - f.value(z - d)).scaled(0.5 / step);
                    let slope = f.slope(z, f.value(z)) * direction;
                    let off = (difference - slope).norm2().sqrt();
                    assert!(off < 1e-8, "{f:?} {z:?}: {difference:?} {slope:?}");
                }
            }
        }
    }

    #[test]
    fn inverses_undo() {
        use HypercomplexFunction::*;
        let z = Complex::new(0.4, -0.3);
        for (f, inverse) in [
            (Sin, Asin),
            (Cos, Acos),
            (Tan, Atan),
            (Sinh, Asinh),
            (Cosh, Acosh),
            (Tanh, Atanh),
            (Exp, Ln),
        ] {
            let back = f.value(inverse.value(z));
            assert!((back - z).norm2() < 1e-28, "{f:?}: {back:?}");
        }
        let (third, back) = (Power(1.0 / 3.0, 0.0).value(z), Cube);
        assert!((back.value(third) - z).norm2() < 1e-28);
    }
}
