//! Bounds of a value and of how fast it changes along a line: interval arithmetic on the rules of differentiation.
//!
//! A rate is known only where the value is continuous. Whatever jumps within the part of the line (a step, a pole, a branch that is not
//! decided), and whatever may be no number there, has the rate [`Bounds::UNKNOWN`]. So a value whose rate has one sign is monotone.

use crate::bounds::Bounds;
use crate::domain::{Domain, Round};
use crate::field::{ScalarField, values_within};
use crate::op::{BinaryOp, UnaryOp};

/// Bounds of a value on a part of a line, and of its derivative along it.
#[derive(Clone, Copy, Debug)]
pub struct Rate {
    /// Bounds of the value.
    pub value: Bounds,
    /// Bounds of the derivative.
    pub rate: Bounds,
    /// The value in the middle of the part, if it is known to change linearly; else NaN.
    pub middle: f64,
}

const ZERO: Bounds = Bounds::new(0.0, 0.0);
const ONE: Bounds = Bounds::new(1.0, 1.0);

impl Rate {
    /// A value that need not change linearly, with its rate, which counts only if the value is certainly finite.
    pub(crate) fn new(value: Bounds, rate: Bounds) -> Self {
        let is_finite = value.min > f64::NEG_INFINITY && value.max < f64::INFINITY;
        let is_known = is_finite && !value.nan && !rate.nan && !rate.is_empty();
        Self {
            value,
            rate: if is_known { rate } else { Bounds::UNKNOWN },
            middle: f64::NAN,
        }
    }

    /// The same, with a value in the middle.
    fn with_middle(self, middle: f64) -> Self {
        Self { middle, ..self }
    }

    /// A value that does not change along the line.
    pub(crate) fn constant_within(value: Bounds) -> Self {
        Self {
            value,
            rate: ZERO,
            middle: if value.min == value.max {
                value.min
            } else {
                f64::NAN
            },
        }
    }

    /// Whether the value does not change along the line.
    fn is_constant(&self) -> bool {
        self.rate.min == 0.0 && self.rate.max == 0.0 && !self.rate.nan
    }

    /// A value that jumps where it changes.
    fn step(value: Bounds) -> Self {
        let rate = if value.single().is_some() {
            ZERO
        } else {
            Bounds::UNKNOWN
        };
        Self {
            value,
            rate,
            middle: f64::NAN,
        }
    }
}

/// The derivative of an operation on values within `a`, which gives values within `value`; nothing for steps.
#[inline(always)]
fn slope(op: UnaryOp, a: Bounds, value: Bounds) -> Option<Bounds> {
    let squared = a.square();
    Some(match op {
        UnaryOp::Neg => Bounds::new(-1.0, -1.0),
        UnaryOp::Abs => Bounds::new(
            if a.min >= 0.0 { 1.0 } else { -1.0 },
            if a.max <= 0.0 { -1.0 } else { 1.0 },
        ),
        UnaryOp::Square => a.add(a),
        UnaryOp::Power(n) => a
            .power(n.saturating_sub(1))
            .mul(Bounds::point(f64::from(n))),
        UnaryOp::Sqrt => Bounds::point(0.5).div(value),
        UnaryOp::Floor | UnaryOp::Ceil | UnaryOp::Trunc | UnaryOp::Not => return None,
        UnaryOp::Sin => UnaryOp::Cos.bounds(a),
        UnaryOp::Cos => UnaryOp::Sin.bounds(a).neg(),
        UnaryOp::Tan => ONE.add(value.square()),
        UnaryOp::Asin => ONE.div(ONE.sub(squared).sqrt()),
        UnaryOp::Acos => ONE.div(ONE.sub(squared).sqrt()).neg(),
        UnaryOp::Atan => ONE.div(ONE.add(squared)),
        UnaryOp::Sinh => UnaryOp::Cosh.bounds(a),
        UnaryOp::Cosh => UnaryOp::Sinh.bounds(a),
        UnaryOp::Tanh => ONE.sub(value.square()),
        UnaryOp::Asinh => ONE.div(squared.add(ONE).sqrt()),
        UnaryOp::Acosh => ONE.div(squared.sub(ONE).sqrt()),
        UnaryOp::Atanh => ONE.div(ONE.sub(squared)),
        UnaryOp::Exp => value,
        UnaryOp::Ln => ONE.div(a),
        UnaryOp::Log10 => Bounds::point(std::f64::consts::LOG10_E.next_down())
            .hull(Bounds::point(std::f64::consts::LOG10_E.next_up()))
            .div(a),
    })
}

/// The rate of an operation on two values that gives values within `value`.
#[inline(always)]
fn rate(op: BinaryOp, a: Rate, b: Rate, value: Bounds) -> Bounds {
    match op {
        BinaryOp::Add => a.rate.add(b.rate),
        BinaryOp::Sub => a.rate.sub(b.rate),
        BinaryOp::Mul => scaled(a.rate, b.value).add(scaled(b.rate, a.value)),
        BinaryOp::Div => a.rate.sub(scaled(b.rate, value)).div(b.value),
        // Where one is no number the other one is taken.
        BinaryOp::Min | BinaryOp::Max if a.value.nan || b.value.nan => Bounds::UNKNOWN,
        BinaryOp::Min | BinaryOp::Max => {
            let (lower, upper) = if op == BinaryOp::Min { (a, b) } else { (b, a) };
            if lower.value.max < upper.value.min {
                a.rate
            } else if upper.value.max < lower.value.min {
                b.rate
            } else {
                a.rate.hull(b.rate)
            }
        }
        BinaryOp::Mod => match a.value.div(b.value).map_exact(f64::trunc).single() {
            Some(count) => a.rate.sub(b.rate.mul(Bounds::point(count))),
            None => Bounds::UNKNOWN,
        },
        BinaryOp::Triangle => match a.value.triangle_slope(b.value) {
            Some(slope) if b.is_constant() => a.rate.mul(slope),
            _ => Bounds::UNKNOWN,
        },
        BinaryOp::Pow if b.is_constant() => {
            let less = BinaryOp::Pow.bounds(a.value, b.value.sub(ONE));
            b.value.mul(less).mul(a.rate)
        }
        BinaryOp::Pow => {
            let less = BinaryOp::Pow.bounds(a.value, b.value.sub(ONE));
            let by_base = b.value.mul(less).mul(a.rate);
            by_base.add(value.mul(UnaryOp::Ln.bounds(a.value)).mul(b.rate))
        }
        // The branch cut, along the negative axis of `b`.
        BinaryOp::Atan2 if a.value.min <= 0.0 && a.value.max >= 0.0 && !(b.value.min > 0.0) => {
            Bounds::UNKNOWN
        }
        BinaryOp::Atan2 => {
            let square = a.value.square().add(b.value.square());
            a.rate.mul(b.value).sub(b.rate.mul(a.value)).div(square)
        }
        BinaryOp::Less | BinaryOp::LessEqual | BinaryOp::Equal | BinaryOp::And | BinaryOp::Or => {
            Rate::step(value).rate
        }
    }
}

/// What an operation makes of two values in the middle, if it makes linear changes linear.
#[inline(always)]
fn middle(op: BinaryOp, a: Rate, b: Rate) -> f64 {
    let is_number = |x: Rate| x.value.min == x.value.max;
    match op {
        BinaryOp::Add => a.middle + b.middle,
        BinaryOp::Sub => a.middle - b.middle,
        BinaryOp::Mul if is_number(a) || is_number(b) => a.middle * b.middle,
        BinaryOp::Div if is_number(b) => a.middle / b.middle,
        _ => f64::NAN,
    }
}

/// A rate times a factor, which does not matter if the rate is zero.
fn scaled(rate: Bounds, factor: Bounds) -> Bounds {
    if rate == ZERO { ZERO } else { rate.mul(factor) }
}

impl Domain for Rate {
    type Mask = ();
    type Fuel = u64;

    fn fuel(operations: u64) -> u64 {
        operations
    }
    fn constant(value: f64) -> Self {
        Self::constant_within(Bounds::point(value))
    }
    fn unknown() -> Self {
        Self {
            value: Bounds::UNKNOWN,
            rate: Bounds::UNKNOWN,
            middle: f64::NAN,
        }
    }
    #[inline(always)]
    fn unary(op: UnaryOp, a: Self) -> Self {
        if matches!(op, UnaryOp::Sin | UnaryOp::Cos) && !a.is_constant() {
            let [sin, cos] = a.value.waves();
            let (value, slope) = match op {
                UnaryOp::Sin => (sin, cos),
                _ => (cos, sin.neg()),
            };
            return Self::new(value, a.rate.mul(slope));
        }
        let value = op.bounds(a.value);
        if a.is_constant() {
            return Self::constant_within(value);
        }
        match slope(op, a.value, value) {
            Some(slope) if op == UnaryOp::Neg => {
                Self::new(value, a.rate.mul(slope)).with_middle(-a.middle)
            }
            Some(slope) => Self::new(value, a.rate.mul(slope)),
            None => Self::step(value),
        }
    }
    #[inline(always)]
    fn binary(op: BinaryOp, a: Self, b: Self) -> Self {
        let value = op.bounds(a.value, b.value);
        if a.is_constant() && b.is_constant() {
            return Self::constant_within(value);
        }
        Self::new(value, rate(op, a, b, value)).with_middle(middle(op, a, b))
    }
    fn select(selector: Self, negative: Self, zero: Self, positive: Self) -> Self {
        let Bounds { min, max, nan } = selector.value;
        if max < 0.0 && !nan {
            return negative;
        }
        if min > 0.0 {
            return positive;
        }
        let value = Bounds::select(selector.value, negative.value, zero.value, positive.value);
        let all = [selector, negative, zero, positive];
        Self {
            value,
            rate: if all.iter().all(Self::is_constant) {
                ZERO
            } else {
                Bounds::UNKNOWN
            },
            middle: f64::NAN,
        }
    }
    fn field(field: &dyn ScalarField, arguments: &[Self]) -> Self {
        if arguments.iter().all(Self::is_constant) {
            return Self::constant_within(values_within(field, arguments, |a| a.value));
        }
        let (value, rate) = field.rate(arguments);
        Self::new(value, rate)
    }
    fn round(counter: Self, to: Self, fuel: &mut u64, price: u64) -> Round<()> {
        <Bounds as Domain>::round(counter.value, to.value, fuel, price)
    }
    fn blend((): (), new: Self, _old: Self) -> Self {
        new
    }
}
