//! Noise and the sums over its octaves.

use super::octaves::{Octaves, Parameters, Sum};
use super::{Formula, Internal};
use crate::bounds::Bounds;
use crate::cost::Cost;
use crate::field::{
    Rates, ScalarField, central_differences, step, store_one_by_one, values_within,
};
use crate::graph::{Expr, Graph};
use crate::rate::Rate;
use crate::rounding::less;
use std::sync::{Arc, OnceLock};
use strahl_math::DVec3;
use strahl_math::noise::{
    Along, LEAST_REACH, NoiseGenerator, Segment, noise, noise_along, noise_bounds,
    noise_of_neighbours, noise_rate, store_noise,
};

pub(super) const TABLE: &[Internal] = &[
    row("f_noise3d", 0, Kind::Noise),
    row("f_snoise3d", 0, Kind::Signed),
    row("f_noise_generator", 1, Kind::Generator),
    row("f_hetero_mf", 6, Kind::Sum(Sum::Hetero)),
    row("f_ridge", 6, Kind::Sum(Sum::Ridge)),
    row("f_ridged_mf", 6, Kind::Sum(Sum::Ridged)),
];

const fn row(name: &'static str, parameters: usize, kind: Kind) -> Internal {
    Internal {
        name,
        parameters,
        formula: Formula::Noise(kind),
    }
}

/// Which function of noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Noise of the scene's generator.
    Noise,
    /// The same, from -1 to 1.
    Signed,
    /// Noise of the generator that is the fourth argument.
    Generator,
    /// A sum over octaves.
    Sum(Sum),
}

/// A function of noise as a field, whose arguments are the point and the parameters.
#[derive(Debug)]
struct NoiseFunction {
    kind: Kind,
    generator: NoiseGenerator,
    /// The sum over octaves with the first parameters it was asked for; most have no others.
    first: OnceLock<Octaves>,
}

pub(super) fn build(
    graph: &mut Graph,
    kind: Kind,
    generator: NoiseGenerator,
    arguments: &[Expr],
) -> Expr {
    let field: Arc<dyn ScalarField> = Arc::new(NoiseFunction {
        kind,
        generator,
        first: OnceLock::new(),
    });
    graph.field(&field, arguments)
}

impl NoiseFunction {
    /// What a sum over octaves with these parameters gives.
    #[inline]
    fn with<T>(&self, sum: Sum, parameters: &Parameters, give: impl Fn(&Octaves) -> T) -> T {
        let first = self.first.get_or_init(|| Octaves::new(sum, parameters));
        if first.has(parameters) {
            give(first)
        } else {
            give(&Octaves::new(sum, parameters))
        }
    }
}

/// POV-Ray takes any number but 2 and 3 for the first generator.
pub(super) fn numbered(number: f64) -> NoiseGenerator {
    match number.trunc() {
        2.0 => NoiseGenerator::RangeCorrected,
        3.0 => NoiseGenerator::Perlin,
        _ => NoiseGenerator::Original,
    }
}

impl ScalarField for NoiseFunction {
    fn arity(&self) -> usize {
        match self.kind {
            Kind::Noise | Kind::Signed => 3,
            Kind::Generator => 4,
            Kind::Sum(_) => 9,
        }
    }

    fn value(&self, arguments: &[f64]) -> f64 {
        let (&[x, y, z, ref rest @ ..], true) = (arguments, arguments.len() == self.arity()) else {
            return f64::NAN;
        };
        let p = DVec3::new(x, y, z);
        match (self.kind, rest) {
            (Kind::Noise, _) => noise(p, self.generator),
            (Kind::Signed, _) => 2.0 * noise(p, self.generator) - 1.0,
            (Kind::Generator, &[number]) => noise(p, numbered(number)),
            (Kind::Sum(sum), rest) => match rest.first_chunk() {
                Some(parameters) => self.with(sum, parameters, |octaves| octaves.value(p)),
                None => f64::NAN,
            },
            (Kind::Generator, _) => f64::NAN,
        }
    }

    fn gains_together(&self) -> bool {
        let is_one_noise = matches!(self.kind, Kind::Noise | Kind::Signed);
        is_one_noise && self.generator != NoiseGenerator::Perlin
    }

    fn store_values(&self, arguments: &[&[f64]], values: &mut [f64]) {
        let count = values.len();
        if let (Kind::Noise | Kind::Signed, &[x, y, z]) = (self.kind, arguments)
            && let (Some(x), Some(y), Some(z)) = (x.get(..count), y.get(..count), z.get(..count))
        {
            store_noise([x, y, z], self.generator, values);
            if self.kind == Kind::Signed {
                for value in values {
                    *value = 2.0 * *value - 1.0;
                }
            }
            return;
        }
        store_one_by_one(self, arguments, values);
    }

    fn cost(&self) -> Cost {
        match self.kind {
            Kind::Noise | Kind::Signed | Kind::Generator => Cost::FORMULA,
            // An octave takes one noise or two.
            Kind::Sum(_) => Cost::operations(1024),
        }
    }

    fn is_bounded(&self) -> bool {
        true
    }

    fn bounds(&self, arguments: &[Bounds]) -> Bounds {
        if let (Kind::Noise, &[x, y, z]) = (self.kind, arguments) {
            let mut bounds = noise_within([x, y, z], self.generator);
            bounds.nan = !(is_finite(&x) && is_finite(&y) && is_finite(&z));
            return bounds;
        }
        let (&[x, y, z, ref rest @ ..], true) = (arguments, arguments.len() == self.arity()) else {
            return Bounds::NAN;
        };
        let nan = ![x, y, z].iter().all(is_finite);
        let p = [x, y, z];
        let Some(numbers) = numbers(rest.iter()) else {
            return Bounds::UNKNOWN;
        };
        if let Kind::Sum(sum) = self.kind {
            return self.with(sum, &numbers, |octaves| octaves.bounds(&p));
        }
        let rest = &numbers[..rest.len().min(numbers.len())];
        let bounds = match (self.kind, rest) {
            (Kind::Noise, _) => noise_within(p, self.generator),
            (Kind::Signed, _) => signed_within(p, self.generator),
            (Kind::Generator, &[number]) => noise_within(p, numbered(number)),
            _ => Bounds::NAN,
        };
        bounds.with_nan(nan)
    }

    /// The central differences of all three coordinates, with their bits.
    fn gradient(&self, arguments: &[f64], partials: &mut [f64]) -> f64 {
        let (&[x, y, z, ref rest @ ..], [by_x, by_y, by_z]) = (arguments, &mut *partials) else {
            return central_differences(self, arguments, partials);
        };
        let (a, b, c) = (step(x), step(y), step(z));
        let first = [[x, x + a, x - a, x], [y, y, y, y + b], [z, z, z, z]];
        let second = [[x, x, x, x], [y - b, y, y, y], [z, z + c, z - c, z]];
        let points = [first, second];
        let values = match (self.kind, rest.first_chunk()) {
            (Kind::Noise | Kind::Signed, None) => {
                let [[a, b, c, d], [e, f, g, h]] = noise_of_neighbours(&points, self.generator);
                let mut values = [a, b, c, d, e, f, g, h];
                if let Kind::Signed = self.kind {
                    for value in &mut values {
                        *value = 2.0 * *value - 1.0;
                    }
                }
                values
            }
            (Kind::Sum(sum), Some(parameters)) => self.with(sum, parameters, |octaves| {
                octaves.values_of_neighbours(&points)
            }),
            _ => return central_differences(self, arguments, partials),
        };
        let [
            value,
            above_x,
            below_x,
            above_y,
            below_y,
            above_z,
            below_z,
            _,
        ] = values;
        *by_x = (above_x - below_x) / ((x + a) - (x - a));
        *by_y = (above_y - below_y) / ((y + b) - (y - b));
        *by_z = (above_z - below_z) / ((z + c) - (z - c));
        value
    }

    fn rates(&self) -> Rates {
        match self.kind {
            // In boxes they change so fast that rates hardly ever tell more than bounds of the value.
            Kind::Sum(_) => Rates::OfSegments,
            Kind::Noise | Kind::Signed | Kind::Generator => Rates::OfBoxes,
        }
    }

    fn rate(&self, arguments: &[Rate]) -> (Bounds, Bounds) {
        let unknown = || (values_within(self, arguments, |a| a.value), Bounds::UNKNOWN);
        let Some((point @ [x, y, z], rest)) = arguments.split_first_chunk() else {
            return unknown();
        };
        if !point
            .iter()
            .all(|x| is_finite(&x.value) && is_finite(&x.rate))
        {
            return unknown();
        }
        let segment = segment(point);
        let generator = match (self.kind, rest) {
            (Kind::Noise | Kind::Signed, []) => Some(self.generator),
            (Kind::Generator, [number]) => number.value.single().map(numbered),
            (Kind::Sum(sum), rest) => {
                let numbers = numbers(rest.iter().map(|number| &number.value));
                let found = segment
                    .zip(numbers)
                    .and_then(|((segment, speed), numbers)| {
                        let (value, rate) =
                            self.with(sum, &numbers, |octaves| octaves.along(segment))?;
                        Some((value, rate.mul(Bounds::point(speed))))
                    });
                return found.unwrap_or_else(unknown);
            }
            _ => None,
        };
        let Some(generator) = generator else {
            return unknown();
        };
        let mut found = None;
        if let Some((segment, speed)) = segment {
            let along = noise_along(segment, generator);
            if along != Along::UNKNOWN {
                let (fall, rise) = along.rate;
                found = Some((along.value, (fall * speed, rise * speed)));
            }
        }
        let ((low, high), (fall, rise)) = found.unwrap_or_else(|| {
            let min = DVec3::new(x.value.min, y.value.min, z.value.min);
            let max = DVec3::new(x.value.max, y.value.max, z.value.max);
            let way = [x, y, z].map(|x| (x.rate.min, x.rate.max));
            noise_rate(min, max, &way, generator)
        });
        let (value, rate) = (Bounds::new(low, high), Bounds::new(fall, rise));
        match self.kind {
            Kind::Signed => (signed(value), rate.mul(Bounds::point(2.0))),
            _ => (value, rate),
        }
    }
}

/// The parameters of a sum, if they are known.
fn numbers<'a>(arguments: impl Iterator<Item = &'a Bounds>) -> Option<Parameters> {
    let mut numbers = [0.0; 6];
    for (number, argument) in numbers.iter_mut().zip(arguments) {
        *number = argument.single()?;
    }
    Some(numbers)
}

/// The segment on which a point goes, if it goes along a straight line and not too short a way, and how fast the segment's parameter changes
/// with that of the line.
fn segment(point: &[Rate; 3]) -> Option<(Segment, f64)> {
    /// Linear functions have rates as narrow as rounding allows.
    const NARROW: f64 = 1e-13;
    let (mut middle, mut way) = ([0.0; 3], [0.0; 3]);
    // Half of the range of the line's parameter; on each axis the point goes no further than its bounds.
    let mut half = f64::INFINITY;
    for (
        axis,
        Rate {
            value,
            rate,
            middle: m,
        },
    ) in point.iter().enumerate()
    {
        (middle[axis], way[axis]) = (*m, 0.5 * (rate.min + rate.max));
        let speed = way[axis].abs();
        // Also refuses NaN.
        if !(m.abs() < f64::INFINITY && rate.max - rate.min <= NARROW * speed) {
            return None;
        }
        if speed > 0.0 {
            half = less(half, 0.5 * (value.max - value.min) / speed);
        }
    }
    let reach = DVec3::from_array(way) * half;
    let is_long = reach.abs().max_element() >= LEAST_REACH;
    let middle = DVec3::from_array(middle);
    (half > 0.0 && is_long).then(|| (Segment { middle, reach }, 1.0 / half))
}

/// Whether all numbers within bounds are finite: noise has no value where a coordinate is not.
fn is_finite(b: &Bounds) -> bool {
    b.min.is_finite() && b.max.is_finite() && !b.nan
}

/// Bounds of the noise over a box.
fn noise_within([x, y, z]: [Bounds; 3], generator: NoiseGenerator) -> Bounds {
    let min = DVec3::new(x.min, y.min, z.min);
    let (low, high) = noise_bounds(min, DVec3::new(x.max, y.max, z.max), generator);
    Bounds::new(low, high)
}

/// Noise from 0 to 1 as noise from -1 to 1.
pub(super) fn signed(noise: Bounds) -> Bounds {
    noise.mul(Bounds::point(2.0)).sub(Bounds::point(1.0))
}

/// Bounds of the noise from -1 to 1.
fn signed_within(p: [Bounds; 3], generator: NoiseGenerator) -> Bounds {
    signed(noise_within(p, generator))
}
