//! Values as linear changes within a box: reduced affine arithmetic, beside intervals.
//!
//! Intervals forget that two values change together: `x - x` is anything up to the width of `x`. An affine form remembers how a value changes
//! along the sides of the box, so what its bounds are too wide by shrinks with the square of the box.
//!
//! J. L. D. Comba, J. Stolfi, "Affine arithmetic and its applications to computer graphics", SIBGRAPI 1993; A. Knoll et al., "Fast ray
//! tracing of arbitrary implicit surfaces with interval and affine arithmetic", Computer Graphics Forum 28 (2009).

use crate::bounds::{Bounds, LIBRARY_ERROR, POWER_ERROR};
use crate::domain::{Domain, Round};
use crate::field::{ScalarField, values_within};
use crate::op::{BinaryOp, UnaryOp};
use crate::rate::{Rate, rate, slope};
use crate::rounding::{greater, less};
use strahl_math::det;

/// More than the rounding errors of an operation on affine forms, relative to the largest of its terms.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// A value within a box: what `middle + Σ slopes[k] δ[k]` is, give or take `rest`, where `δ` goes from -1 to 1 along each side of the box.
/// If the rest is infinite, the bounds are all that is known.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Affine {
    /// Bounds of the value, those of intervals or narrower.
    pub(crate) bounds: Bounds,
    middle: f64,
    slopes: [f64; 3],
    rest: f64,
}

/// The middle of an interval and half of its width; infinite unless the interval is finite.
fn middle_and_reach(bounds: Bounds) -> (f64, f64) {
    if bounds.min == bounds.max {
        return (bounds.min, 0.0);
    }
    let middle = 0.5 * bounds.min + 0.5 * bounds.max;
    let reach = greater(bounds.max - middle, middle - bounds.min).next_up();
    if reach < f64::INFINITY && !bounds.nan && reach >= 0.0 {
        (middle, reach)
    } else {
        (0.0, f64::INFINITY)
    }
}

/// The largest absolute value.
fn size(bounds: Bounds) -> f64 {
    greater(bounds.min.abs(), bounds.max.abs())
}

/// An affine form without its bounds.
#[derive(Clone, Copy)]
struct Form {
    middle: f64,
    slopes: [f64; 3],
    rest: f64,
}

impl Form {
    /// How far the value may be from its middle.
    fn reach(&self) -> f64 {
        self.slopes.iter().map(|s| s.abs()).sum::<f64>() + self.rest
    }

    /// The sum with a multiple.
    fn plus(self, factor: f64, other: Self) -> Self {
        let mut slopes = self.slopes;
        for (slope, other) in slopes.iter_mut().zip(other.slopes) {
            *slope += factor * other;
        }
        Self {
            middle: self.middle + factor * other.middle,
            slopes,
            rest: self.rest + factor.abs() * other.rest,
        }
    }

    fn times(self, other: Self) -> Self {
        let mut slopes = self.slopes;
        for (slope, change) in slopes.iter_mut().zip(other.slopes) {
            *slope = *slope * other.middle + self.middle * change;
        }
        let (a, b) = (self.reach(), other.reach());
        let size = (self.middle.abs() + a) * (other.middle.abs() + b);
        Self {
            middle: self.middle * other.middle,
            slopes,
            rest: self.rest * other.middle.abs()
                + self.middle.abs() * other.rest
                + a * b
                + ROUNDING * size,
        }
    }

    fn square(self) -> Self {
        let reach = self.reach();
        // The square of the distance from the middle is not negative.
        let half = 0.5 * reach * reach;
        let twice = 2.0 * self.middle;
        Self {
            middle: self.middle * self.middle + half,
            slopes: self.slopes.map(|slope| slope * twice),
            rest: self.rest * twice.abs() + half + ROUNDING * (self.middle * self.middle + half),
        }
    }

    fn power(self, exponent: u8) -> Self {
        let mut square = self;
        let mut result: Option<Self> = None;
        let mut bits = exponent;
        loop {
            if bits & 1 == 1 {
                result = Some(result.map_or(square, |r| r.times(square)));
            }
            bits >>= 1;
            if bits == 0 {
                break;
            }
            square = square.square();
        }
        result.unwrap_or(Self {
            middle: 1.0,
            slopes: [0.0; 3],
            rest: 0.0,
        })
    }
}

impl Affine {
    /// The argument that changes along a side of the box within these bounds, or one that is not linear in any.
    pub(crate) fn argument(side: usize, bounds: Bounds) -> Self {
        let mut argument = Self::within(bounds.with_both_zeros());
        if let Some(slope) = argument.slopes.get_mut(side)
            && argument.rest < f64::INFINITY
        {
            *slope = argument.rest;
            argument.rest = ROUNDING * size(bounds);
        }
        argument
    }

    /// A value of which the bounds are known alone.
    fn within(bounds: Bounds) -> Self {
        let (middle, rest) = middle_and_reach(bounds);
        Self {
            bounds,
            middle,
            slopes: [0.0; 3],
            rest,
        }
    }

    /// A value with these bounds that is also within this form, but for rounding errors relative to `terms`.
    fn new(bounds: Bounds, form: Form, terms: f64) -> Self {
        let slack = ROUNDING * (form.middle.abs() + form.reach() + terms) + f64::MIN_POSITIVE;
        let rest = form.rest + slack;
        let reach = form.reach() + slack;
        if !(reach < f64::INFINITY) || bounds.nan || bounds.is_empty() {
            return Self::within(bounds);
        }
        let (low, high) = (form.middle - reach, form.middle + reach);
        let narrow = Bounds {
            // A zero here promises nothing about its sign.
            min: greater(bounds.min, -(0.0 - low)),
            max: less(bounds.max, high),
            nan: false,
        };
        Self {
            bounds: if narrow.is_empty() { bounds } else { narrow },
            middle: form.middle,
            slopes: form.slopes,
            rest,
        }
    }

    fn form(&self) -> Form {
        Form {
            middle: self.middle,
            slopes: self.slopes,
            rest: self.rest,
        }
    }

    fn is_known(&self) -> bool {
        self.rest < f64::INFINITY
    }

    /// `value + Σ slope (a - place)` over arguments `a` near their places, give or take `rest`: by the mean value theorem a function's value if
    /// the rest is that of its slopes.
    fn linear(bounds: Bounds, value: f64, rest: f64, changes: &[(f64, Self, f64)]) -> Self {
        let mut form = Form {
            middle: value,
            slopes: [0.0; 3],
            rest,
        };
        let mut terms = 0.0;
        for &(slope, argument, place) in changes {
            form = form.plus(slope, argument.form());
            form.middle -= slope * place;
            terms += slope.abs() * (argument.middle.abs() + place.abs() + argument.form().reach());
        }
        Self::new(bounds, form, terms)
    }
}

/// The largest error of an operation's values, relative to the largest of them.
const OPERATION_ERROR: f64 = 2.0
    * if LIBRARY_ERROR > POWER_ERROR {
        LIBRARY_ERROR
    } else {
        POWER_ERROR
    };

/// The square root of values from `bounds.min`, which is not negative: between the secant and the parallel tangent.
fn sqrt(a: Affine, bounds: Bounds) -> Affine {
    let (low, high) = (a.bounds.min.sqrt(), a.bounds.max.sqrt());
    let sum = low + high;
    if !(sum > f64::MIN_POSITIVE) {
        return Affine::within(bounds);
    }
    let gap = (high - low) * (high - low) / (8.0 * sum);
    let rest = gap + OPERATION_ERROR * high;
    Affine::linear(bounds, low + gap, rest, &[(1.0 / sum, a, a.bounds.min)])
}

/// A sine or cosine: Taylor's polynomial of degree one, whose rest is at most half of the square of the distance.
fn wave(op: UnaryOp, a: Affine, bounds: Bounds) -> Affine {
    let (place, reach) = middle_and_reach(a.bounds);
    let (sin, cos) = det::sin_cos(place);
    let (value, slope) = if op == UnaryOp::Sin {
        (sin, cos)
    } else {
        (cos, -sin)
    };
    // The second derivative is the value with another sign.
    let rest = 0.5 * reach * reach * size(bounds) + OPERATION_ERROR;
    Affine::linear(bounds, value, rest, &[(slope, a, place)])
}

impl Domain for Affine {
    type Mask = ();
    type Fuel = u64;

    fn fuel(operations: u64) -> u64 {
        operations
    }
    fn constant(value: f64) -> Self {
        Self::within(Bounds::point(value))
    }
    fn unknown() -> Self {
        Self::within(Bounds::UNKNOWN)
    }
    fn unary(op: UnaryOp, a: Self) -> Self {
        let bounds = op.bounds(a.bounds);
        if bounds.min == bounds.max || !a.is_known() || bounds.nan {
            return Self::within(bounds);
        }
        match op {
            UnaryOp::Neg => {
                return Self {
                    bounds,
                    middle: -a.middle,
                    slopes: a.slopes.map(|slope| -slope),
                    rest: a.rest,
                };
            }
            UnaryOp::Square => return Self::new(bounds, a.form().square(), 0.0),
            UnaryOp::Power(n) => return Self::new(bounds, a.form().power(n), 0.0),
            UnaryOp::Sqrt if a.bounds.min >= 0.0 => return sqrt(a, bounds),
            UnaryOp::Sin | UnaryOp::Cos => return wave(op, a, bounds),
            _ => {}
        }
        let change = slope(op, a.bounds, bounds).map(|slope| Rate::new(bounds, slope).rate);
        let Some(change) = change.map(middle_and_reach) else {
            return Self::within(bounds);
        };
        let (place, reach) = middle_and_reach(a.bounds);
        let (value, error) = middle_and_reach(op.bounds(Bounds::point(place)));
        let rest = change.1 * reach + error + OPERATION_ERROR * size(bounds);
        Self::linear(bounds, value, rest, &[(change.0, a, place)])
    }
    fn binary(op: BinaryOp, a: Self, b: Self) -> Self {
        let bounds = op.bounds(a.bounds, b.bounds);
        if bounds.min == bounds.max || !a.is_known() || !b.is_known() || bounds.nan {
            return Self::within(bounds);
        }
        match op {
            BinaryOp::Add => return Self::new(bounds, a.form().plus(1.0, b.form()), 0.0),
            BinaryOp::Sub => return Self::new(bounds, a.form().plus(-1.0, b.form()), 0.0),
            BinaryOp::Mul => return Self::new(bounds, a.form().times(b.form()), 0.0),
            _ => {}
        }
        let (place_a, reach_a) = middle_and_reach(a.bounds);
        let (place_b, reach_b) = middle_and_reach(b.bounds);
        let partial = |reach: f64, rates: [Bounds; 2]| {
            if reach == 0.0 {
                return (0.0, 0.0);
            }
            let [a, b] = [(a, rates[0]), (b, rates[1])].map(|(x, rate)| Rate {
                value: x.bounds,
                rate,
                middle: f64::NAN,
            });
            middle_and_reach(Rate::new(bounds, rate(op, a, b, bounds)).rate)
        };
        let by_a = partial(reach_a, [Bounds::point(1.0), Bounds::point(0.0)]);
        let by_b = partial(reach_b, [Bounds::point(0.0), Bounds::point(1.0)]);
        let at = op.bounds(Bounds::point(place_a), Bounds::point(place_b));
        let (value, error) = middle_and_reach(at);
        // The rounding of what is counted in periods depends on how many there are.
        let rounding = match op {
            BinaryOp::Triangle | BinaryOp::Mod => ROUNDING * (size(a.bounds) + size(b.bounds)),
            _ => OPERATION_ERROR * size(bounds),
        };
        let rest = by_a.1 * reach_a + by_b.1 * reach_b + error + rounding;
        let changes = [(by_a.0, a, place_a), (by_b.0, b, place_b)];
        Self::linear(bounds, value, rest, &changes)
    }
    fn select(selector: Self, negative: Self, zero: Self, positive: Self) -> Self {
        let Bounds { min, max, nan } = selector.bounds;
        if max < 0.0 && !nan {
            return negative;
        }
        if min > 0.0 {
            return positive;
        }
        Self::within(Bounds::select(
            selector.bounds,
            negative.bounds,
            zero.bounds,
            positive.bounds,
        ))
    }
    fn field(field: &dyn ScalarField, arguments: &[Self]) -> Self {
        Self::within(values_within(field, arguments, |a| a.bounds))
    }
    fn round(counter: Self, to: Self, fuel: &mut u64, price: u64) -> Round<()> {
        <Bounds as Domain>::round(counter.bounds, to.bounds, fuel, price)
    }
    fn blend((): (), new: Self, _old: Self) -> Self {
        new
    }
}
