//! Noise and the sums over its octaves.

use super::octaves::{Octaves, Parameters, Sum};
use super::{Formula, Internal};
use crate::bounds::Bounds;
use crate::cost::Cost;
use crate::field::{ScalarField, central_differences, step, store_one_by_one};
use crate::graph::{Expr, Graph};
use std::sync::{Arc, OnceLock};
use strahl_math::DVec3;
use strahl_math::noise::{
    NoiseGenerator, noise, noise_bounds, noise_of_neighbours, noise_rate, store_noise,
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
        let mut numbers = [0.0; 6];
        for (number, parameter) in numbers.iter_mut().zip(rest) {
            match parameter.single() {
                Some(known) => *number = known,
                None => return Bounds::UNKNOWN,
            }
        }
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

    /// Sums over octaves change so fast that rates hardly ever tell more than bounds of the value.
    fn has_rates(&self) -> bool {
        matches!(self.kind, Kind::Noise | Kind::Signed | Kind::Generator)
    }

    fn rate(&self, arguments: &[Bounds], rates: &[Bounds]) -> (Bounds, Bounds) {
        let unknown = || (self.bounds(arguments), Bounds::UNKNOWN);
        let (&[x, y, z, ref rest @ ..], &[p, q, r, ..]) = (arguments, rates) else {
            return unknown();
        };
        let generator = match (self.kind, rest) {
            (Kind::Noise | Kind::Signed, []) => Some(self.generator),
            (Kind::Generator, [number]) => number.single().map(numbered),
            _ => None,
        };
        let Some(generator) = generator.filter(|_| [x, y, z, p, q, r].iter().all(is_finite)) else {
            return unknown();
        };
        let min = DVec3::new(x.min, y.min, z.min);
        let max = DVec3::new(x.max, y.max, z.max);
        let way = [p, q, r].map(|r| (r.min, r.max));
        let ((low, high), (fall, rise)) = noise_rate(min, max, &way, generator);
        let (value, rate) = (Bounds::new(low, high), Bounds::new(fall, rise));
        match self.kind {
            Kind::Signed => (signed(value), rate.mul(Bounds::point(2.0))),
            _ => (value, rate),
        }
    }
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
