//! Noise and the sums over its octaves: terrains of Musgrave's kind.
//!
//! The sums are those of Ebert, Musgrave et al., Texturing and Modeling (chapter 16: hetero terrain, ridged multifractal);
//! how POV-Ray counts fractions of an octave and reads its parameters was measured.

use super::{Formula, Internal};
use crate::bounds::Bounds;
use crate::cost::Cost;
use crate::field::{ScalarField, central_differences, step, store_one_by_one};
use crate::graph::{Expr, Graph};
use std::sync::Arc;
use strahl_math::DVec3;
use strahl_math::det;
use strahl_math::noise::{
    NoiseGenerator, noise, noise_bounds, noise_of_neighbours, noise_rate, store_noise,
};

pub(super) const TABLE: &[Internal] = &[
    row("f_noise3d", 0, Kind::Noise),
    row("f_snoise3d", 0, Kind::Signed),
    row("f_noise_generator", 1, Kind::Generator),
    row("f_hetero_mf", 6, Kind::Hetero),
    row("f_ridge", 6, Kind::Ridge),
    row("f_ridged_mf", 6, Kind::Ridged),
];

const fn row(name: &'static str, parameters: usize, kind: Kind) -> Internal {
    Internal {
        name,
        parameters,
        formula: Formula::Noise(kind),
    }
}

/// Octaves beyond this number are left out: their frequencies have left the range of the lattice long before.
const OCTAVES: f64 = 256.0;

/// Which function of noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Noise of the scene's generator.
    Noise,
    /// The same, from -1 to 1.
    Signed,
    /// Noise of the generator that is the fourth argument.
    Generator,
    /// A terrain that is smooth where it is low.
    Hetero,
    /// A mean over octaves of how far noise is from the ridge.
    Ridge,
    /// Ridges that are rough where they are high.
    Ridged,
}

/// A function of noise as a field, whose arguments are the point and the parameters.
#[derive(Debug)]
struct NoiseFunction {
    kind: Kind,
    generator: NoiseGenerator,
}

pub(super) fn build(
    graph: &mut Graph,
    kind: Kind,
    generator: NoiseGenerator,
    arguments: &[Expr],
) -> Expr {
    let field: Arc<dyn ScalarField> = Arc::new(NoiseFunction { kind, generator });
    graph.field(&field, arguments)
}

/// POV-Ray takes any number but 2 and 3 for the first generator.
fn numbered(number: f64) -> NoiseGenerator {
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
            Kind::Hetero | Kind::Ridge | Kind::Ridged => 9,
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
            (Kind::Hetero, rest) => Octaves::new(p, rest).map_or(f64::NAN, |o| o.hetero()),
            (Kind::Ridge, rest) => ridge(p, rest),
            (Kind::Ridged, rest) => Octaves::new(p, rest).map_or(f64::NAN, |o| o.ridged()),
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
            Kind::Hetero | Kind::Ridge | Kind::Ridged => Cost::operations(1024),
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
        let rest = &numbers[..rest.len().min(numbers.len())];
        let bounds = match (self.kind, rest) {
            (Kind::Noise, _) => noise_within(p, self.generator),
            (Kind::Signed, _) => signed_within(p, self.generator),
            (Kind::Generator, &[number]) => noise_within(p, numbered(number)),
            (Kind::Hetero, rest) => {
                Octaves::new(DVec3::ZERO, rest).map_or(Bounds::UNKNOWN, |o| o.hetero_within(p))
            }
            (Kind::Ridge, rest) => ridge_within(p, rest),
            (Kind::Ridged, rest) => {
                Octaves::new(DVec3::ZERO, rest).map_or(Bounds::UNKNOWN, |o| o.ridged_within(p))
            }
            (Kind::Generator, _) => Bounds::NAN,
        };
        bounds.with_nan(nan)
    }

    /// The central differences of all three coordinates, with their bits.
    fn gradient(&self, arguments: &[f64], partials: &mut [f64]) -> f64 {
        let (Kind::Noise | Kind::Signed, &[x, y, z], [by_x, by_y, by_z]) =
            (self.kind, arguments, &mut *partials)
        else {
            return central_differences(self, arguments, partials);
        };
        let (a, b, c) = (step(x), step(y), step(z));
        let first = [[x, x + a, x - a, x], [y, y, y, y + b], [z, z, z, z]];
        let second = [[x, x, x, x], [y - b, y, y, y], [z, z + c, z - c, z]];
        let [mut first, mut second] = noise_of_neighbours(&[first, second], self.generator);
        if let Kind::Signed = self.kind {
            for value in first.iter_mut().chain(&mut second) {
                *value = 2.0 * *value - 1.0;
            }
        }
        let [value, above_x, below_x, above_y] = first;
        let [below_y, above_z, below_z, _] = second;
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
fn signed(noise: Bounds) -> Bounds {
    noise.mul(Bounds::point(2.0)).sub(Bounds::point(1.0))
}

/// Bounds of the noise from -1 to 1.
fn signed_within(p: [Bounds; 3], generator: NoiseGenerator) -> Bounds {
    signed(noise_within(p, generator))
}

/// The box of the next octave.
fn scaled(p: [Bounds; 3], factor: f64) -> [Bounds; 3] {
    p.map(|b| b.mul(Bounds::point(factor)))
}

/// The parameters of a sum over octaves.
struct Octaves {
    p: DVec3,
    /// How fast amplitudes fall with frequency.
    h: f64,
    lacunarity: f64,
    octaves: f64,
    offset: f64,
    /// `T` of the hetero terrain, the gain of the ridges.
    last: f64,
    generator: NoiseGenerator,
}

impl Octaves {
    fn new(p: DVec3, rest: &[f64]) -> Option<Self> {
        let &[h, lacunarity, octaves, offset, last, generator] = rest else {
            return None;
        };
        Some(Self {
            p,
            h,
            lacunarity,
            octaves: if octaves < OCTAVES { octaves } else { OCTAVES },
            offset,
            last,
            generator: numbered(generator),
        })
    }

    /// Noise from -1 to 1.
    fn signed(&self, p: DVec3) -> f64 {
        2.0 * noise(p, self.generator) - 1.0
    }

    fn hetero(&self) -> f64 {
        let mut p = self.p;
        let mut value = self.offset + self.signed(p);
        let mut frequency = self.lacunarity;
        p *= self.lacunarity;
        let mut octave = 1.0;
        while octave < self.octaves {
            let increment = (self.signed(p) + self.offset) * det::pow(frequency, -self.h);
            // The height takes part as often as the whole part of T says.
            value += increment * det::pow(value, self.last.trunc());
            frequency *= self.lacunarity;
            p *= self.lacunarity;
            octave += 1.0;
        }
        // A fraction of an octave adds the next one in part.
        let rest = self.octaves - self.octaves.trunc();
        if rest != 0.0 {
            let increment = (self.signed(p) + self.offset) * det::pow(frequency, -self.h);
            value += rest * increment * value;
        }
        value
    }

    /// POV-Ray itself keeps the weights of the octaves from the first call in a scene, so that a second set of parameters
    /// gets wrong ones; this uses those of the parameters at hand.
    fn ridged(&self) -> f64 {
        let ridge = |p: DVec3| {
            let height = self.offset - self.signed(p).abs();
            height * height
        };
        let mut p = self.p;
        let mut signal = ridge(p);
        let mut value = signal;
        let mut frequency = self.lacunarity;
        let mut octave = 1.0;
        while octave < self.octaves {
            p *= self.lacunarity;
            let weight = signal * self.last;
            let weight = if weight > 1.0 {
                1.0
            } else if weight > 0.0 {
                weight
            } else {
                0.0
            };
            signal = ridge(p) * weight;
            value += signal * det::pow(frequency, -self.h);
            frequency *= self.lacunarity;
            octave += 1.0;
        }
        value
    }
}

/// The sums over octaves on bounds, step by step as on numbers.
impl Octaves {
    fn hetero_within(&self, p: [Bounds; 3]) -> Bounds {
        let mut p = p;
        let offset = Bounds::point(self.offset);
        let mut value = offset.add(signed_within(p, self.generator));
        let mut frequency = self.lacunarity;
        let increment = |p, frequency| {
            let height = signed_within(p, self.generator).add(offset);
            height.mul(Bounds::point(det::pow(frequency, -self.h)))
        };
        p = scaled(p, self.lacunarity);
        let mut octave = 1.0;
        while octave < self.octaves {
            let share = value.pow(Bounds::point(self.last.trunc()));
            value = value.add(increment(p, frequency).mul(share));
            frequency *= self.lacunarity;
            p = scaled(p, self.lacunarity);
            octave += 1.0;
        }
        let rest = self.octaves - self.octaves.trunc();
        if rest != 0.0 {
            let share = Bounds::point(rest).mul(increment(p, frequency));
            value = value.add(share.mul(value));
        }
        value
    }

    fn ridged_within(&self, p: [Bounds; 3]) -> Bounds {
        let ridge = |p| {
            let distance = signed_within(p, self.generator).abs();
            Bounds::point(self.offset).sub(distance).square()
        };
        let mut p = p;
        let mut signal = ridge(p);
        let mut value = signal;
        let mut frequency = self.lacunarity;
        let mut octave = 1.0;
        while octave < self.octaves {
            p = scaled(p, self.lacunarity);
            let weight = signal.mul(Bounds::point(self.last));
            let weight = weight
                .minimum(Bounds::point(1.0))
                .maximum(Bounds::point(0.0));
            signal = ridge(p).mul(weight);
            value = value.add(signal.mul(Bounds::point(det::pow(frequency, -self.h))));
            frequency *= self.lacunarity;
            octave += 1.0;
        }
        value
    }
}

/// The mean of octaves with weights `omega` to the power of their number, each the distance of the noise from `ridge`
/// less `offset`, both scaled to at most one.
fn ridge(p: DVec3, rest: &[f64]) -> f64 {
    let mut p = p;
    mean_of_octaves(
        rest,
        0.0,
        |sum, lambda, share, (ridge, offset, generator)| {
            let distance = (noise(p, generator) - ridge).abs() / larger(ridge);
            p *= lambda;
            sum + share * ((distance - offset) / larger(offset))
        },
    )
    .map_or(f64::NAN, |(sum, total)| sum / total)
}

/// The same on bounds.
fn ridge_within(p: [Bounds; 3], rest: &[f64]) -> Bounds {
    let mut p = p;
    let zero = Bounds::point(0.0);
    mean_of_octaves(
        rest,
        zero,
        |sum, lambda, share, (ridge, offset, generator)| {
            let point = Bounds::point;
            let distance = noise_within(p, generator).sub(point(ridge)).abs();
            let distance = distance.div(point(larger(ridge))).sub(point(offset));
            p = scaled(p, lambda);
            sum.add(point(share).mul(distance.div(point(larger(offset)))))
        },
    )
    .map_or(Bounds::NAN, |(sum, total)| sum.div(Bounds::point(total)))
}

/// The distance of 0 or 1, whichever is further.
fn larger(a: f64) -> f64 {
    if a > 1.0 - a { a } else { 1.0 - a }
}

/// Adds up the octaves of [`ridge`] by `add`, which gets the sum so far, `lambda`, the weight, and the ridge, its offset and the
/// generator; gives the sum and the total of the weights.
fn mean_of_octaves<T>(
    rest: &[f64],
    zero: T,
    mut add: impl FnMut(T, f64, f64, (f64, f64, NoiseGenerator)) -> T,
) -> Option<(T, f64)> {
    let &[lambda, octaves, omega, offset, ridge, generator] = rest else {
        return None;
    };
    let parameters = (ridge, offset, numbered(generator));
    let octaves = if octaves < OCTAVES { octaves } else { OCTAVES };
    // The first octave counts in full, a fraction adds the next one in part.
    let whole = if octaves >= 1.0 { octaves.trunc() } else { 1.0 };
    let rest = octaves - octaves.trunc();
    let (mut sum, mut total, mut weight, mut octave) = (zero, 0.0, 1.0, 0.0);
    while octave < whole || rest > 0.0 && octave == whole {
        let share = if octave < whole {
            weight
        } else {
            weight * rest
        };
        sum = add(sum, lambda, share, parameters);
        total += share;
        weight *= omega;
        octave += 1.0;
    }
    Some((sum, total))
}
