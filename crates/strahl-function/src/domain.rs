//! The domains over which a tape can be run: numbers, lanes of numbers, intervals, numbers with derivatives.

use crate::bounds::Bounds;
use crate::field::ScalarField;
use crate::limits;
use crate::op::{BinaryOp, UnaryOp, power};
use strahl_math::det;

/// Whether a loop continues.
pub(crate) enum Round<M> {
    /// It does, for the values of the mask.
    Go(M),
    /// It would for the values of the mask, but they have too little fuel, which is taken away.
    Starved(M),
    /// It is done.
    Done,
    /// Unknown.
    Unknown,
}

/// Values that operations work on.
///
/// For every domain an operation gives the same bits as the operation on numbers, or bounds that contain them.
pub(crate) trait Domain: Copy {
    /// The values that take part in a round of a loop.
    type Mask: Copy;
    /// The number of operations that the loops of an evaluation may still take.
    type Fuel: Copy;

    fn fuel(operations: u64) -> Self::Fuel;
    fn constant(value: f64) -> Self;
    /// The value if nothing is known.
    fn unknown() -> Self;
    fn unary(op: UnaryOp, a: Self) -> Self;
    fn binary(op: BinaryOp, a: Self, b: Self) -> Self;
    fn select(selector: Self, negative: Self, zero: Self, positive: Self) -> Self;
    fn field(field: &dyn ScalarField, arguments: &[Self]) -> Self;
    /// Whether a loop whose counter is `counter` runs once more, which takes `price` operations.
    ///
    /// As everything below, this must cost a value as much fuel alone as within a batch; otherwise its bits would differ.
    fn round(counter: Self, to: Self, fuel: &mut Self::Fuel, price: u64) -> Round<Self::Mask>;
    /// Sets the fuel of all values outside of the mask to zero, for a round in which they are computed in vain.
    fn ration(_fuel: &mut Self::Fuel, _mask: Self::Mask) {}
    /// Restores the fuel of these values.
    fn restore(_fuel: &mut Self::Fuel, _mask: Self::Mask, _before: Self::Fuel) {}
    /// `new` where the mask says so, else `old`.
    fn blend(mask: Self::Mask, new: Self, old: Self) -> Self;
}

/// Subtracts the price, or everything if there is less.
fn pay(fuel: &mut u64, price: u64) -> bool {
    let rest = fuel.checked_sub(price);
    *fuel = rest.unwrap_or(0);
    rest.is_some()
}

impl Domain for f64 {
    type Mask = ();
    type Fuel = u64;

    fn fuel(operations: u64) -> u64 {
        operations
    }
    fn constant(value: f64) -> Self {
        value
    }
    fn unknown() -> Self {
        f64::NAN
    }
    #[inline]
    fn unary(op: UnaryOp, a: Self) -> Self {
        op.value(a)
    }
    #[inline]
    fn binary(op: BinaryOp, a: Self, b: Self) -> Self {
        op.value(a, b)
    }
    #[inline]
    fn select(selector: Self, negative: Self, zero: Self, positive: Self) -> Self {
        if selector < 0.0 {
            negative
        } else if selector == 0.0 {
            zero
        } else {
            positive
        }
    }
    fn field(field: &dyn ScalarField, arguments: &[Self]) -> Self {
        field.value(arguments)
    }
    fn round(counter: Self, to: Self, fuel: &mut u64, price: u64) -> Round<()> {
        if !(counter <= to) {
            Round::Done
        } else if pay(fuel, price) {
            Round::Go(())
        } else {
            Round::Starved(())
        }
    }
    fn blend((): (), new: Self, _old: Self) -> Self {
        new
    }
}

/// How many points a batch evaluates with each instruction: enough to share the cost of decoding it, few enough that the
/// registers of usual functions stay in the first cache. Other widths have not been measured.
pub(crate) const LANES: usize = 16;

/// As many numbers as a batch evaluates together.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Lanes(pub(crate) [f64; LANES]);

impl Lanes {
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        let mut out = self.0;
        for x in &mut out {
            *x = f(*x);
        }
        Self(out)
    }

    /// Changed by a function that changes all numbers of a list.
    #[inline(always)]
    fn all(mut self, change: impl FnOnce(&mut [f64])) -> Self {
        change(&mut self.0);
        self
    }

    /// Whether all numbers are the same.
    fn is_same(&self) -> bool {
        self.0.iter().all(|x| x.to_bits() == self.0[0].to_bits())
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let mut out = self.0;
        for (x, y) in out.iter_mut().zip(other.0) {
            *x = f(*x, y);
        }
        Self(out)
    }
}

impl Domain for Lanes {
    type Mask = [bool; LANES];
    type Fuel = [u64; LANES];

    fn fuel(operations: u64) -> [u64; LANES] {
        [operations; LANES]
    }
    fn constant(value: f64) -> Self {
        Self([value; LANES])
    }
    fn unknown() -> Self {
        Self::constant(f64::NAN)
    }
    // The operation is decoded once, outside of the loop over lanes, for those that vectorise.
    #[inline]
    fn unary(op: UnaryOp, a: Self) -> Self {
        match op {
            UnaryOp::Neg => a.map(|x| -x),
            UnaryOp::Abs => a.map(f64::abs),
            UnaryOp::Square => a.map(|x| x * x),
            UnaryOp::Sqrt => a.map(f64::sqrt),
            UnaryOp::Power(n) => {
                // As det::pow multiplies, for all lanes at once.
                if n > 64 {
                    return a.map(|x| power(x, n));
                }
                let (mut result, mut square, mut bits) = (Self::constant(1.0), a, n);
                while bits > 0 {
                    if bits & 1 == 1 {
                        result = result.zip(square, |x, y| x * y);
                    }
                    square = square.map(|x| x * x);
                    bits >>= 1;
                }
                result
            }
            UnaryOp::Sin => a.all(det::sin_all),
            UnaryOp::Cos => a.all(det::cos_all),
            op => a.map(|x| op.value(x)),
        }
    }
    #[inline]
    fn binary(op: BinaryOp, a: Self, b: Self) -> Self {
        match op {
            BinaryOp::Pow if b.is_same() => a.all(|bases| det::pow_all(bases, b.0[0])),
            BinaryOp::Add => a.zip(b, |x, y| x + y),
            BinaryOp::Sub => a.zip(b, |x, y| x - y),
            BinaryOp::Mul => a.zip(b, |x, y| x * y),
            BinaryOp::Div => a.zip(b, |x, y| x / y),
            BinaryOp::Min => a.zip(b, |x, y| BinaryOp::Min.value(x, y)),
            BinaryOp::Max => a.zip(b, |x, y| BinaryOp::Max.value(x, y)),
            BinaryOp::Triangle => a.zip(b, |x, y| BinaryOp::Triangle.value(x, y)),
            BinaryOp::Less => a.zip(b, |x, y| BinaryOp::Less.value(x, y)),
            BinaryOp::LessEqual => a.zip(b, |x, y| BinaryOp::LessEqual.value(x, y)),
            op => a.zip(b, |x, y| op.value(x, y)),
        }
    }
    #[inline]
    fn select(selector: Self, negative: Self, zero: Self, positive: Self) -> Self {
        let mut out = positive.0;
        for (i, x) in out.iter_mut().enumerate() {
            *x = f64::select(selector.0[i], negative.0[i], zero.0[i], *x);
        }
        Self(out)
    }
    fn field(field: &dyn ScalarField, arguments: &[Self]) -> Self {
        let mut columns: [&[f64]; limits::PARAMETERS] = [&[]; limits::PARAMETERS];
        let arity = arguments.len().min(limits::PARAMETERS);
        for (column, lanes) in columns.iter_mut().zip(arguments) {
            *column = &lanes.0;
        }
        let mut out = [0.0; LANES];
        field.store_values(&columns[..arity], &mut out);
        Self(out)
    }
    fn round(counter: Self, to: Self, fuel: &mut [u64; LANES], price: u64) -> Round<[bool; LANES]> {
        let mut mask = [false; LANES];
        let mut starved = [false; LANES];
        for (i, active) in mask.iter_mut().enumerate() {
            *active = counter.0[i] <= to.0[i];
            starved[i] = *active && fuel[i] < price;
        }
        if starved.contains(&true) {
            for (fuel, starved) in fuel.iter_mut().zip(starved) {
                *fuel = if starved { 0 } else { *fuel };
            }
            return Round::Starved(starved);
        }
        if !mask.contains(&true) {
            return Round::Done;
        }
        for (fuel, active) in fuel.iter_mut().zip(mask) {
            *fuel -= if active { price } else { 0 };
        }
        Round::Go(mask)
    }
    fn ration(fuel: &mut [u64; LANES], mask: [bool; LANES]) {
        for (fuel, active) in fuel.iter_mut().zip(mask) {
            *fuel = if active { *fuel } else { 0 };
        }
    }
    fn restore(fuel: &mut [u64; LANES], mask: [bool; LANES], before: [u64; LANES]) {
        for ((fuel, active), before) in fuel.iter_mut().zip(mask).zip(before) {
            *fuel = if active { *fuel } else { before };
        }
    }
    fn blend(mask: [bool; LANES], new: Self, old: Self) -> Self {
        let mut out = old.0;
        for (i, x) in out.iter_mut().enumerate() {
            if mask[i] {
                *x = new.0[i];
            }
        }
        Self(out)
    }
}

impl Domain for Bounds {
    type Mask = ();
    type Fuel = u64;

    fn fuel(operations: u64) -> u64 {
        operations
    }
    fn constant(value: f64) -> Self {
        Self::point(value)
    }
    fn unknown() -> Self {
        Self::UNKNOWN
    }
    #[inline(always)]
    fn unary(op: UnaryOp, a: Self) -> Self {
        op.bounds(a)
    }
    #[inline(always)]
    fn binary(op: BinaryOp, a: Self, b: Self) -> Self {
        op.bounds(a, b)
    }
    fn select(selector: Self, negative: Self, zero: Self, positive: Self) -> Self {
        let mut result: Option<Self> = None;
        let mut include = |possible: bool, value: Self| {
            if possible {
                result = Some(result.map_or(value, |r| r.hull(value)));
            }
        };
        include(selector.min < 0.0, negative);
        include(selector.min <= 0.0 && selector.max >= 0.0, zero);
        include(selector.nan || selector.max > 0.0, positive);
        result.unwrap_or(Self::UNKNOWN)
    }
    fn field(field: &dyn ScalarField, arguments: &[Self]) -> Self {
        field.bounds(arguments)
    }
    fn round(counter: Self, to: Self, fuel: &mut u64, price: u64) -> Round<()> {
        if counter.is_empty() || to.is_empty() || counter.min > to.max {
            return Round::Done;
        }
        if counter.max <= to.min && !counter.nan && !to.nan && pay(fuel, price) {
            return Round::Go(());
        }
        // The cost of the loop is unknown, too: a following one may find no fuel.
        *fuel = 0;
        Round::Unknown
    }
    fn blend((): (), new: Self, _old: Self) -> Self {
        new
    }
}

/// A number with its derivatives by three variables.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dual {
    pub(crate) value: f64,
    pub(crate) partials: [f64; 3],
}

impl Dual {
    pub(crate) const fn number(value: f64) -> Self {
        Self {
            value,
            partials: [0.0; 3],
        }
    }

    /// [`Domain::field`] for up to so many arguments.
    fn field_of<const MOST: usize>(field: &dyn ScalarField, arguments: &[Self]) -> Self {
        let mut point = [0.0; MOST];
        let mut partials = [0.0; MOST];
        let arity = arguments.len().min(MOST);
        for (x, dual) in point.iter_mut().zip(arguments) {
            *x = dual.value;
        }
        // The last ones are often constants.
        let changes = |dual: &Self| dual.partials != [0.0; 3];
        let changing = arguments.iter().rposition(changes).map_or(0, |at| at + 1);
        let value = field.gradient(&point[..arity], &mut partials[..changing.min(arity)]);
        arguments
            .iter()
            .zip(partials)
            .fold(Self::number(value), |sum, (&dual, slope)| {
                sum.along(dual, slope)
            })
    }

    /// Adds a derivative times the slope along it; an argument that doesn't change contributes nothing, however steep it is.
    fn along(mut self, other: Self, slope: f64) -> Self {
        for (total, partial) in self.partials.iter_mut().zip(other.partials) {
            if partial != 0.0 {
                *total += partial * slope;
            }
        }
        self
    }
}

impl Domain for Dual {
    type Mask = ();
    type Fuel = u64;

    fn fuel(operations: u64) -> u64 {
        operations
    }
    fn constant(value: f64) -> Self {
        Self::number(value)
    }
    fn unknown() -> Self {
        Self::number(f64::NAN)
    }
    #[inline(always)]
    fn unary(op: UnaryOp, a: Self) -> Self {
        if matches!(op, UnaryOp::Sin | UnaryOp::Cos) {
            let (sin, cos) = det::sin_cos(a.value);
            return match op {
                UnaryOp::Sin => Self::number(sin).along(a, cos),
                _ => Self::number(cos).along(a, -sin),
            };
        }
        let value = op.value(a.value);
        Self::number(value).along(a, op.slope(a.value, value))
    }
    #[inline(always)]
    fn binary(op: BinaryOp, a: Self, b: Self) -> Self {
        let value = op.value(a.value, b.value);
        let (by_a, by_b) = op.slopes(a.value, b.value, value);
        Self::number(value).along(a, by_a).along(b, by_b)
    }
    fn select(selector: Self, negative: Self, zero: Self, positive: Self) -> Self {
        if selector.value < 0.0 {
            negative
        } else if selector.value == 0.0 {
            zero
        } else {
            positive
        }
    }
    fn field(field: &dyn ScalarField, arguments: &[Self]) -> Self {
        if arguments.len() <= limits::FEW {
            Self::field_of::<{ limits::FEW }>(field, arguments)
        } else {
            Self::field_of::<{ limits::PARAMETERS }>(field, arguments)
        }
    }
    fn round(counter: Self, to: Self, fuel: &mut u64, price: u64) -> Round<()> {
        <f64 as Domain>::round(counter.value, to.value, fuel, price)
    }
    fn blend((): (), new: Self, _old: Self) -> Self {
        new
    }
}
