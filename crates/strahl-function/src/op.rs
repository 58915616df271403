use crate::bounds::{Bounds, triangle};
use strahl_math::det;

/// An operation on one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UnaryOp {
    /// The value with its sign flipped.
    Neg,
    /// The absolute value.
    Abs,
    /// The value times itself.
    Square,
    /// A whole power from 3 to 64, by repeated squaring in the order of `det::pow`.
    Power(u8),
    /// The square root; NaN below zero.
    Sqrt,
    /// The largest whole number not above the value.
    Floor,
    /// The smallest whole number not below the value.
    Ceil,
    /// The value rounded towards zero.
    Trunc,
    /// 1 for zero, else 0 (also for NaN).
    Not,
    /// Sine of radians.
    Sin,
    /// Cosine of radians.
    Cos,
    /// Tangent of radians.
    Tan,
    /// Arc sine.
    Asin,
    /// Arc cosine.
    Acos,
    /// Arc tangent.
    Atan,
    /// Hyperbolic sine.
    Sinh,
    /// Hyperbolic cosine.
    Cosh,
    /// Hyperbolic tangent.
    Tanh,
    /// Inverse hyperbolic sine.
    Asinh,
    /// Inverse hyperbolic cosine.
    Acosh,
    /// Inverse hyperbolic tangent.
    Atanh,
    /// `e` to the power of the value.
    Exp,
    /// Natural logarithm.
    Ln,
    /// Logarithm to base 10.
    Log10,
}

/// An operation on two values.
///
/// What NaN does was measured with POV-Ray 3.7 (see the crate's oracle tests).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BinaryOp {
    /// The sum.
    Add,
    /// The difference.
    Sub,
    /// The product.
    Mul,
    /// The quotient; division by zero gives infinity or NaN.
    Div,
    /// `if a <= b { a } else { b }`.
    Min,
    /// `if a < b { b } else { a }`.
    Max,
    /// The remainder of truncated division; it has the sign of `a`.
    Mod,
    /// The triangle wave: the distance of `a` from the nearest multiple of `b`.
    Triangle,
    /// `a` to the power of `b`.
    Pow,
    /// The angle of the point `(b, a)` in radians.
    Atan2,
    /// 1 if `a < b`, else 0.
    Less,
    /// 1 if `a <= b`, else 0.
    LessEqual,
    /// 1 if `a == b` exactly, else 0.
    Equal,
    /// 1 if neither is zero, else 0.
    And,
    /// 1 unless both are zero.
    Or,
}

pub(crate) fn boolean(truth: bool) -> f64 {
    f64::from(u8::from(truth))
}

/// `x` to a whole power; the same bits as `det::pow`.
pub(crate) fn power(x: f64, exponent: u8) -> f64 {
    det::pow(x, f64::from(exponent))
}

impl UnaryOp {
    /// The operation on a number.
    #[inline]
    pub fn value(self, a: f64) -> f64 {
        match self {
            Self::Neg => -a,
            Self::Abs => a.abs(),
            Self::Square => a * a,
            Self::Power(n) => power(a, n),
            Self::Sqrt => a.sqrt(),
            Self::Floor => a.floor(),
            Self::Ceil => a.ceil(),
            Self::Trunc => a.trunc(),
            Self::Not => boolean(a == 0.0),
            Self::Sin => det::sin(a),
            Self::Cos => det::cos(a),
            Self::Tan => det::tan(a),
            Self::Asin => det::asin(a),
            Self::Acos => det::acos(a),
            Self::Atan => det::atan(a),
            Self::Sinh => det::sinh(a),
            Self::Cosh => det::cosh(a),
            Self::Tanh => det::tanh(a),
            Self::Asinh => det::asinh(a),
            Self::Acosh => det::acosh(a),
            Self::Atanh => det::atanh(a),
            Self::Exp => det::exp(a),
            Self::Ln => det::ln(a),
            Self::Log10 => det::log10(a),
        }
    }

    /// Bounds of the operation on every number within bounds.
    #[inline]
    pub fn bounds(self, a: Bounds) -> Bounds {
        use std::f64::consts::{FRAC_PI_2, PI};
        const ALL: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
        let (half_pi, pi) = (FRAC_PI_2.next_up(), PI.next_up());
        match self {
            Self::Neg => a.neg(),
            Self::Abs => a.abs(),
            Self::Square => a.square(),
            Self::Power(n) => a.power(n),
            Self::Sqrt => a.sqrt(),
            Self::Floor => a.map_exact(f64::floor),
            Self::Ceil => a.map_exact(f64::ceil),
            Self::Trunc => a.map_exact(f64::trunc),
            Self::Not => a
                .truth()
                .map_or(Bounds::BOOLEAN, |t| Bounds::point(boolean(!t))),
            Self::Sin => a.wave(det::sin, 0.0),
            Self::Cos => a.wave(det::cos, 0.25),
            Self::Tan => a.tan(),
            Self::Asin => a
                .restrict(-1.0, 1.0)
                .map_rising(det::asin, (-half_pi, half_pi)),
            // The arc cosine falls: mirror its argument.
            Self::Acos => a
                .restrict(-1.0, 1.0)
                .neg()
                .map_rising(|x| det::acos(-x), (0.0, pi)),
            Self::Atan => a.map_rising(det::atan, (-half_pi, half_pi)),
            Self::Sinh => a.map_rising(det::sinh, ALL),
            Self::Cosh => a.abs().map_rising(det::cosh, (1.0, f64::INFINITY)),
            Self::Tanh => a.map_rising(det::tanh, (-1.0, 1.0)),
            Self::Asinh => a.map_rising(det::asinh, ALL),
            Self::Acosh => a
                .restrict(1.0, f64::INFINITY)
                .map_rising(det::acosh, (0.0, f64::INFINITY)),
            Self::Atanh => a.restrict(-1.0, 1.0).map_rising(det::atanh, ALL),
            Self::Exp => a.map_rising(det::exp, (0.0, f64::INFINITY)),
            Self::Ln => a.restrict(-0.0, f64::INFINITY).map_rising(det::ln, ALL),
            Self::Log10 => a.restrict(-0.0, f64::INFINITY).map_rising(det::log10, ALL),
        }
    }

    /// The derivative at `a`, where the operation gives `value`; 0 at steps and corners.
    pub fn slope(self, a: f64, value: f64) -> f64 {
        match self {
            Self::Neg => -1.0,
            Self::Abs => {
                if a > 0.0 {
                    1.0
                } else if a < 0.0 {
                    -1.0
                } else {
                    0.0
                }
            }
            Self::Square => 2.0 * a,
            Self::Power(n) => f64::from(n) * power(a, n.saturating_sub(1)),
            Self::Sqrt => 0.5 / value,
            Self::Floor | Self::Ceil | Self::Trunc | Self::Not => 0.0,
            Self::Sin => det::cos(a),
            Self::Cos => -det::sin(a),
            Self::Tan => 1.0 + value * value,
            Self::Asin => 1.0 / (1.0 - a * a).sqrt(),
            Self::Acos => -1.0 / (1.0 - a * a).sqrt(),
            Self::Atan => 1.0 / (1.0 + a * a),
            Self::Sinh => det::cosh(a),
            Self::Cosh => det::sinh(a),
            Self::Tanh => 1.0 - value * value,
            Self::Asinh => 1.0 / (a * a + 1.0).sqrt(),
            Self::Acosh => 1.0 / (a * a - 1.0).sqrt(),
            Self::Atanh => 1.0 / (1.0 - a * a),
            Self::Exp => value,
            Self::Ln => 1.0 / a,
            Self::Log10 => std::f64::consts::LOG10_E / a,
        }
    }
}

impl BinaryOp {
    /// The operation on two numbers.
    #[inline]
    pub fn value(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Add => a + b,
            Self::Sub => a - b,
            Self::Mul => a * b,
            Self::Div => a / b,
            Self::Min => {
                if a <= b {
                    a
                } else {
                    b
                }
            }
            Self::Max => {
                if a < b {
                    b
                } else {
                    a
                }
            }
            // The remainder of floating point division is exact, so it is the same on every machine.
            Self::Mod => a % b,
            Self::Triangle => triangle(a, b),
            Self::Pow => det::pow(a, b),
            Self::Atan2 => det::atan2(a, b),
            Self::Less => boolean(a < b),
            Self::LessEqual => boolean(a <= b),
            Self::Equal => boolean(a == b),
            Self::And => boolean(a != 0.0 && b != 0.0),
            Self::Or => boolean(a != 0.0 || b != 0.0),
        }
    }

    /// Bounds of the operation on all pairs of numbers within bounds.
    #[inline]
    pub fn bounds(self, a: Bounds, b: Bounds) -> Bounds {
        match self {
            Self::Add => a.add(b),
            Self::Sub => a.sub(b),
            Self::Mul => a.mul(b),
            Self::Div => a.div(b),
            Self::Min => a.minimum(b),
            Self::Max => a.maximum(b),
            Self::Mod => a.remainder(b),
            Self::Triangle => a.triangle(b),
            Self::Pow => a.pow(b),
            Self::Atan2 => a.atan2(b),
            Self::Less => a.less(b, false),
            Self::LessEqual => a.less(b, true),
            Self::Equal => a.equal(b),
            Self::And => match (a.truth(), b.truth()) {
                (Some(false), _) | (_, Some(false)) => Bounds::point(0.0),
                (Some(true), Some(true)) => Bounds::point(1.0),
                _ => Bounds::BOOLEAN,
            },
            Self::Or => match (a.truth(), b.truth()) {
                (Some(true), _) | (_, Some(true)) => Bounds::point(1.0),
                (Some(false), Some(false)) => Bounds::point(0.0),
                _ => Bounds::BOOLEAN,
            },
        }
    }

    /// The partial derivatives at `(a, b)`, where the operation gives `value`; 0 at steps.
    pub fn slopes(self, a: f64, b: f64, value: f64) -> (f64, f64) {
        match self {
            Self::Add => (1.0, 1.0),
            Self::Sub => (1.0, -1.0),
            Self::Mul => (b, a),
            Self::Div => (1.0 / b, -value / b),
            Self::Min => {
                if a <= b {
                    (1.0, 0.0)
                } else {
                    (0.0, 1.0)
                }
            }
            Self::Max => {
                if a < b {
                    (0.0, 1.0)
                } else {
                    (1.0, 0.0)
                }
            }
            Self::Mod => (1.0, -(a / b).trunc()),
            Self::Triangle => {
                let count = (a / b + 0.5).floor();
                let slope = UnaryOp::Abs.slope(a - b * count, value);
                (slope, -slope * count)
            }
            Self::Pow => (b * det::pow(a, b - 1.0), value * det::ln(a)),
            Self::Atan2 => {
                let square = a * a + b * b;
                (b / square, -a / square)
            }
            Self::Less | Self::LessEqual | Self::Equal | Self::And | Self::Or => (0.0, 0.0),
        }
    }

    /// Whether `a op b` and `b op a` are the same bits (NaN payloads aside).
    pub(crate) fn is_commutative(self) -> bool {
        matches!(
            self,
            Self::Add | Self::Mul | Self::Equal | Self::And | Self::Or
        )
    }
}
