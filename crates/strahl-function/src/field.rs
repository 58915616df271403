use crate::bounds::Bounds;
use crate::cost::Cost;
use crate::limits;
use crate::rate::Rate;
use std::fmt::Debug;

/// A real function that expressions can call without knowing its formula: a pattern, one channel of a pigment, a spline, noise.
///
/// So functions, patterns and geometry can refer to each other although their crates don't depend on each other.
pub trait ScalarField: Debug + Send + Sync {
    /// How many arguments the field takes; 3 for a field in space. At most [`limits::PARAMETERS`](crate::limits::PARAMETERS).
    fn arity(&self) -> usize {
        3
    }

    /// The value at the arguments, [`arity`](Self::arity) many. The same arguments always give the same bits.
    fn value(&self, arguments: &[f64]) -> f64;

    /// Whether the values at several points take less time together ([`store_values`](Self::store_values)).
    fn gains_together(&self) -> bool {
        false
    }

    /// Stores the values at several points, of which `arguments` has a column of each argument: the bits of [`value`](Self::value). A value whose
    /// columns are too short is NaN. By default one by one.
    fn store_values(&self, arguments: &[&[f64]], values: &mut [f64]) {
        store_one_by_one(self, arguments, values);
    }

    /// The cost of [`value`](Self::value). A field that evaluates others must include their cost, or it may never end.
    fn cost(&self) -> Cost {
        Cost::FORMULA
    }

    /// Whether [`bounds`](Self::bounds) converge to the values as the box becomes small. If not, callers have to rely on a
    /// given maximal gradient to prove that the field is not zero.
    fn is_bounded(&self) -> bool {
        false
    }

    /// An interval that contains the value at all arguments within bounds.
    fn bounds(&self, _arguments: &[Bounds]) -> Bounds {
        Bounds::UNKNOWN
    }

    /// Whether [`rate`](Self::rate) can be known, and of which arguments.
    fn rates(&self) -> Rates {
        Rates::Unknown
    }

    /// Bounds of the value, and of the derivative along a line on which the arguments change as told; [`Bounds::UNKNOWN`] where the value may
    /// jump or be no number.
    fn rate(&self, arguments: &[Rate]) -> (Bounds, Bounds) {
        (values_within(self, arguments, |a| a.value), Bounds::UNKNOWN)
    }

    /// The value, which must have the bits of [`value`](Self::value), and its partial derivatives by the first arguments, as many as
    /// `partials` has.
    ///
    /// By default central differences, good to about ten digits where the field is smooth.
    fn gradient(&self, arguments: &[f64], partials: &mut [f64]) -> f64 {
        central_differences(self, arguments, partials)
    }
}

/// Of which arguments a rate of change can be known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rates {
    /// Of none.
    Unknown,
    /// Of those that go along a straight line.
    OfSegments,
    /// Of all those whose own rates are known.
    OfBoxes,
}

/// [`ScalarField::bounds`] for arguments of which more than their bounds is known.
pub(crate) fn values_within<A>(
    field: &(impl ScalarField + ?Sized),
    arguments: &[A],
    bounds: impl Fn(&A) -> Bounds,
) -> Bounds {
    let mut values = [Bounds::UNKNOWN; limits::PARAMETERS];
    for (value, argument) in values.iter_mut().zip(arguments) {
        *value = bounds(argument);
    }
    field.bounds(&values[..arguments.len().min(limits::PARAMETERS)])
}

/// [`ScalarField::store_values`] one by one.
pub(crate) fn store_one_by_one(
    field: &(impl ScalarField + ?Sized),
    arguments: &[&[f64]],
    values: &mut [f64],
) {
    let mut point = [0.0; limits::PARAMETERS];
    let arity = arguments.len().min(limits::PARAMETERS);
    for (at, value) in values.iter_mut().enumerate() {
        for (x, column) in point.iter_mut().zip(arguments) {
            *x = column.get(at).copied().unwrap_or(f64::NAN);
        }
        *value = field.value(&point[..arity]);
    }
}

/// How far from a place the values are taken of which the difference is the derivative: the cube root of the unit roundoff balances rounding
/// against the third derivative.
pub(crate) fn step(x: f64) -> f64 {
    6e-6 * if x.abs() > 1.0 { x.abs() } else { 1.0 }
}

/// [`ScalarField::gradient`] by central differences.
pub(crate) fn central_differences(
    field: &(impl ScalarField + ?Sized),
    arguments: &[f64],
    partials: &mut [f64],
) -> f64 {
    let mut shifted = [0.0; limits::PARAMETERS];
    let shifted = &mut shifted[..arguments.len().min(limits::PARAMETERS)];
    shifted.copy_from_slice(&arguments[..shifted.len()]);
    for (i, partial) in partials.iter_mut().enumerate().take(shifted.len()) {
        let x = shifted[i];
        let step = step(x);
        shifted[i] = x + step;
        let above = field.value(shifted);
        let high = shifted[i];
        shifted[i] = x - step;
        *partial = (above - field.value(shifted)) / (high - shifted[i]);
        shifted[i] = x;
    }
    field.value(arguments)
}
