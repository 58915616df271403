//! Named operations of the graph's builder.

use crate::graph::{Expr, Graph};
use crate::op::{BinaryOp, UnaryOp};

macro_rules! unary {
    ($($(#[$doc:meta])* $name:ident = $op:ident;)*) => {
        impl Graph {
            $($(#[$doc])* pub fn $name(&mut self, a: Expr) -> Expr {
                self.unary(UnaryOp::$op, a)
            })*
        }
    };
}

macro_rules! binary {
    ($($(#[$doc:meta])* $name:ident = $op:ident;)*) => {
        impl Graph {
            $($(#[$doc])* pub fn $name(&mut self, a: Expr, b: Expr) -> Expr {
                self.binary(BinaryOp::$op, a, b)
            })*
        }
    };
}

unary! {
    /// `-a`.
    neg = Neg;
    /// The absolute value.
    abs = Abs;
    /// `a * a`.
    square = Square;
    /// The square root; NaN below zero.
    sqrt = Sqrt;
    /// The largest whole number not above `a`.
    floor = Floor;
    /// The smallest whole number not below `a`.
    ceil = Ceil;
    /// `a` rounded towards zero: POV-Ray's `int`. (POV-Ray gives -2147483648 where the result does not fit 32 bits.)
    int = Trunc;
    /// 1 for zero, else 0: logical `!`.
    not = Not;
    /// Sine of radians.
    sin = Sin;
    /// Cosine of radians.
    cos = Cos;
    /// Tangent of radians.
    tan = Tan;
    /// Arc sine; NaN outside of `-1..=1`.
    asin = Asin;
    /// Arc cosine; NaN outside of `-1..=1`.
    acos = Acos;
    /// Arc tangent.
    atan = Atan;
    /// Hyperbolic sine.
    sinh = Sinh;
    /// Hyperbolic cosine.
    cosh = Cosh;
    /// Hyperbolic tangent.
    tanh = Tanh;
    /// Inverse hyperbolic sine.
    asinh = Asinh;
    /// Inverse hyperbolic cosine; NaN below 1.
    acosh = Acosh;
    /// Inverse hyperbolic tangent; NaN outside of `-1..=1`.
    atanh = Atanh;
    /// `e` to the power of `a`.
    exp = Exp;
    /// Natural logarithm: `-inf` at 0, NaN below.
    ln = Ln;
    /// Logarithm to base 10.
    log = Log10;
}

binary! {
    /// `a + b`.
    add = Add;
    /// `a - b`.
    sub = Sub;
    /// `a * b`.
    mul = Mul;
    /// `a / b`; infinite or NaN for a divisor of zero.
    div = Div;
    /// The remainder of truncated division, with the sign of `a`.
    modulo = Mod;
    /// The distance of `a` from the nearest multiple of `b`: a triangle wave.
    triangle = Triangle;
    /// `a` to the power of `b`; NaN for a negative `a` unless `b` is whole.
    pow = Pow;
    /// The angle of the point `(b, a)`.
    atan2 = Atan2;
    /// `a < b`: 1 or 0.
    less = Less;
    /// `a <= b`: 1 or 0.
    less_equal = LessEqual;
    /// `a = b`, exactly: 1 or 0.
    equal = Equal;
    /// `a & b`: 1 or 0.
    and = And;
    /// `a | b`: 1 or 0.
    or = Or;
}

impl Graph {
    /// `a > b`. As in POV-Ray the opposite of `a <= b`, so it is 1 if one of them is NaN.
    pub fn greater(&mut self, a: Expr, b: Expr) -> Expr {
        let opposite = self.less_equal(a, b);
        self.not(opposite)
    }

    /// `a >= b`. As in POV-Ray the opposite of `a < b`, so it is 1 if one of them is NaN.
    pub fn greater_equal(&mut self, a: Expr, b: Expr) -> Expr {
        let opposite = self.less(a, b);
        self.not(opposite)
    }

    /// `a != b`, exactly; 1 if one of them is NaN.
    pub fn not_equal(&mut self, a: Expr, b: Expr) -> Expr {
        let opposite = self.equal(a, b);
        self.not(opposite)
    }

    /// POV-Ray's `div`: the quotient rounded towards zero.
    pub fn int_div(&mut self, a: Expr, b: Expr) -> Expr {
        let quotient = self.div(a, b);
        self.int(quotient)
    }

    /// Radians to degrees.
    pub fn degrees(&mut self, a: Expr) -> Expr {
        self.scaled(a, 180.0 / std::f64::consts::PI)
    }

    /// Degrees to radians.
    pub fn radians(&mut self, a: Expr) -> Expr {
        self.scaled(a, std::f64::consts::PI / 180.0)
    }

    /// The smallest of any number of values, compared from left to right (`+inf` of none).
    pub fn min(&mut self, values: &[Expr]) -> Expr {
        self.fold(BinaryOp::Min, values, f64::INFINITY)
    }

    /// The largest of any number of values, compared from left to right (`-inf` of none).
    pub fn max(&mut self, values: &[Expr]) -> Expr {
        self.fold(BinaryOp::Max, values, f64::NEG_INFINITY)
    }

    /// The sum of any number of values, from left to right.
    pub fn total(&mut self, values: &[Expr]) -> Expr {
        self.fold(BinaryOp::Add, values, 0.0)
    }

    /// The product of any number of values, from left to right.
    pub fn product(&mut self, values: &[Expr]) -> Expr {
        self.fold(BinaryOp::Mul, values, 1.0)
    }

    fn fold(&mut self, op: BinaryOp, values: &[Expr], neutral: f64) -> Expr {
        match values.split_first() {
            None => self.constant(neutral),
            Some((&first, rest)) => rest.iter().fold(first, |a, &b| self.binary(op, a, b)),
        }
    }

    /// A known number times `a`.
    pub fn scaled(&mut self, a: Expr, factor: f64) -> Expr {
        let factor = self.constant(factor);
        self.mul(a, factor)
    }

    /// `a` plus a known number.
    pub fn offset(&mut self, a: Expr, number: f64) -> Expr {
        let number = self.constant(number);
        self.add(a, number)
    }

    /// `a` to a whole power.
    pub fn powi(&mut self, a: Expr, exponent: u8) -> Expr {
        let exponent = self.constant(f64::from(exponent));
        self.pow(a, exponent)
    }

    /// The sum of the squares.
    pub fn norm2(&mut self, values: &[Expr]) -> Expr {
        let squares: Vec<Expr> = values.iter().map(|&v| self.square(v)).collect();
        self.total(&squares)
    }

    /// The Euclidean length of a vector.
    pub fn length(&mut self, values: &[Expr]) -> Expr {
        let square = self.norm2(values);
        self.sqrt(square)
    }

    /// `value`, but not below `low` nor above `high`.
    pub fn clamp(&mut self, value: Expr, low: f64, high: f64) -> Expr {
        let (low, high) = (self.constant(low), self.constant(high));
        let limited = self.min(&[value, high]);
        self.max(&[limited, low])
    }
}
