//! Sums over octaves of noise: terrains of Musgrave's kind.
//!
//! The sums are those of Ebert, Musgrave et al., Texturing and Modeling (chapter 16: hetero terrain, ridged multifractal);
//! how POV-Ray counts fractions of an octave and reads its parameters was measured.
//!
//! The noise of several octaves is computed side by side; what does not depend on the point is computed once.

mod rates;

use super::fractal::numbered;
use crate::bounds::Bounds;
use crate::rounding::{greater, less};
use strahl_math::DVec3;
use strahl_math::det;
use strahl_math::noise::{NoiseGenerator, noise_of_neighbours, store_octave_bounds, store_octaves};

/// Octaves beyond this number are left out: their frequencies have left the range of the lattice long before.
const OCTAVES: f64 = 256.0;

/// How many octaves are computed side by side at most.
const TOGETHER: usize = 16;

/// The parameters of a sum.
pub(super) type Parameters = [f64; 6];

/// Two numbers, the lower one first.
type Range = (f64, f64);

/// Noise has a value up to this distance from the origin.
const FARTHEST: f64 = 1e30;

/// Numbers below it are taken for zero, or it for them, so that none underflows.
const SMALL: f64 = 1e-290;

/// Which sum it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sum {
    /// A terrain that is smooth where it is low.
    Hetero,
    /// A mean over octaves of how far noise is from the ridge.
    Ridge,
    /// Ridges that are rough where they are high.
    Ridged,
}

/// A sum over octaves with its parameters, and what follows from them.
#[derive(Debug)]
pub(super) struct Octaves {
    sum: Sum,
    parameters: Parameters,
    lacunarity: f64,
    generator: NoiseGenerator,
    /// How many octaves there are.
    count: usize,
    /// What octaves are multiplied by; terrains have none for the first one.
    weights: Box<[f64]>,
    /// How much there is of the last octave of a hetero terrain, if not all.
    part: f64,
    offset: f64,
    /// The whole part of `T` of the hetero terrain, the gain of the ridged terrain, the ridge of the mean.
    last: f64,
    /// The sum of the weights of the mean.
    total: f64,
    /// Octaves of a point with coordinates up to this size are within reach of noise.
    reach: f64,
    /// How many times as fast the last octave changes as the first one, if not slower.
    finest: f64,
    /// Whether bounds need no care for numbers that are extreme or have an unusual sign.
    is_usual: bool,
}

impl Octaves {
    pub(super) fn new(sum: Sum, parameters: &Parameters) -> Self {
        match sum {
            Sum::Ridge => Self::mean(parameters),
            Sum::Hetero | Sum::Ridged => Self::terrain(sum, parameters),
        }
    }

    fn terrain(sum: Sum, parameters: &Parameters) -> Self {
        let &[h, lacunarity, octaves, offset, last, generator] = parameters;
        let octaves = if octaves < OCTAVES { octaves } else { OCTAVES };
        // A fraction of an octave adds the next one in part.
        let part = match sum {
            Sum::Hetero => octaves - octaves.trunc(),
            _ => 0.0,
        };
        let (mut weights, mut frequency, mut octave) = (Vec::new(), lacunarity, 1.0);
        let mut add = || {
            weights.push(det::pow(frequency, -h));
            frequency *= lacunarity;
        };
        while octave < octaves {
            add();
            octave += 1.0;
        }
        if part != 0.0 {
            add();
        }
        // The height takes part as often as the whole part of T says.
        let last = match sum {
            Sum::Hetero => last.trunc(),
            _ => last,
        };
        let is_usual = offset.abs() <= 1e100
            && match sum {
                Sum::Hetero => {
                    (last == 0.0 || last == 1.0) && weights.iter().all(|w| w.abs() <= 1e100)
                }
                _ => {
                    (0.0..=1e6).contains(&last) && weights.iter().all(|w| (0.0..=1e100).contains(w))
                }
            };
        Self {
            sum,
            parameters: *parameters,
            lacunarity,
            generator: numbered(generator),
            count: 1 + weights.len(),
            reach: reach(lacunarity, weights.len()),
            finest: finest(lacunarity, weights.len()),
            weights: weights.into(),
            part,
            offset,
            last,
            total: 0.0,
            is_usual,
        }
    }

    fn mean(parameters: &Parameters) -> Self {
        let &[lambda, octaves, omega, offset, ridge, generator] = parameters;
        let octaves = if octaves < OCTAVES { octaves } else { OCTAVES };
        // The first octave counts in full, a fraction adds the next one in part.
        let whole = if octaves >= 1.0 { octaves.trunc() } else { 1.0 };
        let rest = octaves - octaves.trunc();
        let (mut weights, mut total, mut weight, mut octave) = (Vec::new(), 0.0, 1.0, 0.0);
        while octave < whole || rest > 0.0 && octave == whole {
            let share = if octave < whole {
                weight
            } else {
                weight * rest
            };
            weights.push(share);
            total += share;
            weight *= omega;
            octave += 1.0;
        }
        let sizes: f64 = weights.iter().map(|w| w.abs()).sum();
        let is_usual = offset.abs() <= 1e100 && ridge.abs() <= 1e100 && sizes <= 1e100;
        Self {
            sum: Sum::Ridge,
            parameters: *parameters,
            lacunarity: lambda,
            generator: numbered(generator),
            count: weights.len(),
            reach: reach(lambda, weights.len() - 1),
            finest: finest(lambda, weights.len() - 1),
            weights: weights.into(),
            part: 0.0,
            offset,
            last: ridge,
            total,
            is_usual,
        }
    }

    /// Whether these are the parameters, with all their bits.
    pub(super) fn has(&self, parameters: &Parameters) -> bool {
        let mut differ = 0;
        for (a, b) in self.parameters.iter().zip(parameters) {
            differ |= a.to_bits() ^ b.to_bits();
        }
        differ == 0
    }

    fn noises(&self, p: DVec3) -> Noises<'_> {
        Noises {
            of: self,
            p,
            some: [0.0; TOGETHER],
            next: 0,
            end: 0,
            left: self.count,
        }
    }

    /// The value at a point.
    pub(super) fn value(&self, p: DVec3) -> f64 {
        let mut noises = self.noises(p);
        let [value] = self.values(|| [noises.next()]);
        value
    }

    /// The values at eight points close to each other, whose coordinates are given four by four and axis by axis.
    pub(super) fn values_of_neighbours(&self, points: &[[[f64; 4]; 3]; 2]) -> [f64; 8] {
        let mut points = *points;
        self.values(|| {
            let [[a, b, c, d], [e, f, g, h]] = noise_of_neighbours(&points, self.generator);
            for x in points.as_flattened_mut().as_flattened_mut() {
                *x *= self.lacunarity;
            }
            [a, b, c, d, e, f, g, h]
        })
    }

    /// The values at points whose noise in octave after octave is given.
    #[inline(always)]
    fn values<const N: usize>(&self, noises: impl FnMut() -> [f64; N]) -> [f64; N] {
        match self.sum {
            Sum::Hetero => self.hetero(noises),
            Sum::Ridge => self.ridge(noises),
            Sum::Ridged => self.ridged(noises),
        }
    }

    #[inline(always)]
    fn hetero<const N: usize>(&self, mut noises: impl FnMut() -> [f64; N]) -> [f64; N] {
        let mut values = noises();
        for value in &mut values {
            *value = self.offset + signed(*value);
        }
        let (whole, part) = self.split();
        for weight in whole {
            for (value, noise) in values.iter_mut().zip(noises()) {
                let increment = (signed(noise) + self.offset) * weight;
                *value += increment * det::pow(*value, self.last);
            }
        }
        if let Some(weight) = part {
            for (value, noise) in values.iter_mut().zip(noises()) {
                let increment = (signed(noise) + self.offset) * weight;
                *value += self.part * increment * *value;
            }
        }
        values
    }

    /// The weights of whole octaves, and that of the one that is there in part.
    fn split(&self) -> (&[f64], Option<f64>) {
        match self.weights.split_last() {
            Some((&last, whole)) if self.part != 0.0 => (whole, Some(last)),
            _ => (&self.weights, None),
        }
    }

    /// POV-Ray itself keeps the weights of the octaves from the first call in a scene, so that a second set of parameters
    /// gets wrong ones; this uses those of the parameters at hand.
    #[inline(always)]
    fn ridged<const N: usize>(&self, mut noises: impl FnMut() -> [f64; N]) -> [f64; N] {
        let ridge = |noise| {
            let height = self.offset - signed(noise).abs();
            height * height
        };
        let mut signals = noises();
        for signal in &mut signals {
            *signal = ridge(*signal);
        }
        let mut values = signals;
        for power in &self.weights {
            let noises = noises();
            for ((value, signal), noise) in values.iter_mut().zip(&mut signals).zip(noises) {
                let weight = *signal * self.last;
                let weight = if weight > 1.0 {
                    1.0
                } else if weight > 0.0 {
                    weight
                } else {
                    0.0
                };
                *signal = ridge(noise) * weight;
                *value += *signal * power;
            }
        }
        values
    }

    /// The mean of octaves with weights `omega` to the power of their number, each the distance of the noise from the ridge
    /// less the offset, both scaled to at most one.
    #[inline(always)]
    fn ridge<const N: usize>(&self, mut noises: impl FnMut() -> [f64; N]) -> [f64; N] {
        let mut sums = [0.0; N];
        for share in &self.weights {
            for (sum, noise) in sums.iter_mut().zip(noises()) {
                let distance = (noise - self.last).abs() / larger(self.last);
                *sum += share * ((distance - self.offset) / larger(self.offset));
            }
        }
        for sum in &mut sums {
            *sum /= self.total;
        }
        sums
    }
}

/// The sums on bounds.
impl Octaves {
    /// Bounds of the values over a box.
    pub(super) fn bounds(&self, p: &[Bounds; 3]) -> Bounds {
        let usual = match self.sum {
            _ if !self.is_usual => None,
            Sum::Hetero => self.usual_hetero(self.ranges(p)),
            Sum::Ridge => Some(self.usual_ridge(self.ranges(p))),
            Sum::Ridged => Some(self.usual_ridged(self.ranges(p))),
        };
        let bounds = usual.unwrap_or_else(|| match self.sum {
            Sum::Hetero => self.hetero_within(self.ranges(p)),
            Sum::Ridge => self.ridge_within(self.ranges(p)),
            Sum::Ridged => self.ridged_within(self.ranges(p)),
        });
        let is_near = |b: &Bounds| -self.reach <= b.min && b.max <= self.reach && !b.nan;
        bounds.with_nan(!p.iter().all(is_near))
    }

    fn ranges(&self, [x, y, z]: &[Bounds; 3]) -> Ranges<'_> {
        Ranges {
            of: self,
            area: [
                DVec3::new(x.min, y.min, z.min),
                DVec3::new(x.max, y.max, z.max),
            ],
            some: [FULL; TOGETHER],
            next: 0,
            end: 0,
            left: self.count,
        }
    }

    /// The value grows with the ridge of each octave, so the ends are those of the ends; rounding is allowed for at last.
    fn usual_ridged(&self, mut ranges: Ranges<'_>) -> Bounds {
        let slack = 2.0 * f64::EPSILON * (1.0 + self.offset.abs());
        let ridge = |range: Range| {
            let (near, far) = sizes(2.0 * range.0 - 1.0, 2.0 * range.1 - 1.0);
            let low = self.offset - far - slack;
            let high = self.offset - near + slack;
            let (least, most) = sizes(low, high);
            (least * least, most * most)
        };
        let full = ridge(FULL);
        let mut next = || ranges.next().map_or(full, ridge);
        let (mut least, mut most) = next();
        let (mut low, mut high) = (least, most);
        for power in &self.weights {
            let ends = (least * self.last, most * self.last);
            let weight = if ends.0 > SMALL { ends.0 } else { 0.0 };
            let (a, b) = next();
            least = a * less(weight, 1.0);
            most = b * less(greater(ends.1, SMALL), 1.0);
            low += least * power;
            high += most * power;
        }
        // At most three roundings for each octave.
        let error = 2.0 * f64::EPSILON * (self.count + 2) as f64;
        Bounds::new(
            greater(low - low * error - SMALL.sqrt(), 0.0),
            high + high * error + SMALL.sqrt(),
        )
    }

    /// With a `T` of one the height is a product of a factor for each octave, so the ends are found among those of the ends. `None` if they
    /// are too large.
    fn usual_hetero(&self, mut ranges: Ranges<'_>) -> Option<Bounds> {
        let mut next = || {
            let (low, high) = ranges.next().unwrap_or(FULL);
            let signed = (2.0 * low - 1.0, 2.0 * high - 1.0);
            (signed.0 + self.offset, signed.1 + self.offset)
        };
        let largest = 1.0 + self.offset.abs();
        let rounding = 8.0 * f64::EPSILON;
        let pad = rounding * largest;
        let (low, high) = next();
        let (mut low, mut high) = (low - pad, high + pad);
        let mut add = |weight: f64, is_product: bool| {
            let (a, b) = next();
            let (a, b) = (a * weight, b * weight);
            let (a, b) = (less(a, b), greater(a, b));
            let (size, step) = (greater(-low, high), largest * weight.abs());
            if is_product {
                let (a, b) = (1.0 + a, 1.0 + b);
                let (p, q, r, s) = (low * a, low * b, high * a, high * b);
                let pad = rounding * size * (1.0 + step) + SMALL;
                low = less(less(p, q), less(r, s)) - pad;
                high = greater(greater(p, q), greater(r, s)) + pad;
            } else {
                let pad = rounding * (size + step);
                (low, high) = (low + a - pad, high + b + pad);
            }
        };
        let (whole, part) = self.split();
        for &weight in whole {
            add(weight, self.last == 1.0);
        }
        if let Some(weight) = part {
            add(self.part * weight, true);
        }
        (low.abs() < 1e250 && high.abs() < 1e250).then_some(Bounds::new(low, high))
    }

    fn usual_ridge(&self, mut ranges: Ranges<'_>) -> Bounds {
        let scale = 1.0 / (larger(self.last) * larger(self.offset));
        let (mut low, mut high, mut largest) = (0.0, 0.0, 0.0);
        for share in &self.weights {
            let (from, to) = ranges.next().unwrap_or(FULL);
            let (near, far) = sizes(from - self.last, to - self.last);
            let factor = share * scale;
            let (a, b) = (near * factor, far * factor);
            low += less(a, b);
            high += greater(a, b);
            largest += share.abs();
        }
        let base = self.offset / larger(self.offset);
        let size = largest * ((1.0 + self.last.abs()) * scale + base.abs());
        // A rounding for each octave and some for the terms.
        let pad = f64::EPSILON * (self.count + 8) as f64 * size + SMALL;
        let base = base * self.total;
        Bounds::new(low - base - pad, high - base + pad).div(Bounds::point(self.total))
    }

    /// Step by step as on numbers.
    fn hetero_within(&self, mut ranges: Ranges<'_>) -> Bounds {
        let offset = Bounds::point(self.offset);
        let mut value = offset.add(ranges.signed());
        let mut increment = |weight| ranges.signed().add(offset).mul(Bounds::point(weight));
        let (whole, part) = self.split();
        for &weight in whole {
            let share = value.pow(Bounds::point(self.last));
            value = value.add(increment(weight).mul(share));
        }
        if let Some(weight) = part {
            let share = Bounds::point(self.part).mul(increment(weight));
            value = value.add(share.mul(value));
        }
        value
    }

    fn ridged_within(&self, mut ranges: Ranges<'_>) -> Bounds {
        let mut ridge = || {
            let distance = ranges.signed().abs();
            Bounds::point(self.offset).sub(distance).square()
        };
        let mut signal = ridge();
        let mut value = signal;
        for &power in &self.weights {
            let weight = signal.mul(Bounds::point(self.last));
            let weight = weight
                .minimum(Bounds::point(1.0))
                .maximum(Bounds::point(0.0));
            signal = ridge().mul(weight);
            value = value.add(signal.mul(Bounds::point(power)));
        }
        value
    }

    fn ridge_within(&self, mut ranges: Ranges<'_>) -> Bounds {
        let point = Bounds::point;
        let mut sum = point(0.0);
        for &share in &self.weights {
            let distance = ranges.noise().sub(point(self.last)).abs();
            let distance = distance.div(point(larger(self.last)));
            let height = distance.sub(point(self.offset));
            sum = sum.add(point(share).mul(height.div(point(larger(self.offset)))));
        }
        sum.div(point(self.total))
    }
}

/// How far a point may be from the origin for noise to have a value there and in so many octaves more.
fn reach(lacunarity: f64, octaves: usize) -> f64 {
    let mut reach = FARTHEST;
    for _ in 0..octaves {
        reach /= match lacunarity.abs() {
            growth if growth <= 1.0 => 1.0,
            growth if growth < f64::INFINITY => growth,
            _ => f64::NAN,
        };
    }
    reach
}

/// How many times as fast noise changes after so many octaves more, if not slower.
fn finest(lacunarity: f64, octaves: usize) -> f64 {
    let growth = greater(lacunarity.abs(), 1.0);
    (0..octaves).fold(1.0, |finest, _| finest * growth)
}

/// The distance of 0 or 1, whichever is further.
fn larger(a: f64) -> f64 {
    if a > 1.0 - a { a } else { 1.0 - a }
}

/// Noise from 0 to 1 as noise from -1 to 1.
fn signed(noise: f64) -> f64 {
    2.0 * noise - 1.0
}

/// The least and the largest size of the numbers from `low` to `high`.
#[inline(always)]
fn sizes(low: f64, high: f64) -> Range {
    (
        greater(greater(low, -high), 0.0),
        greater(low.abs(), high.abs()),
    )
}

/// The noise of octave after octave at a point.
struct Noises<'a> {
    of: &'a Octaves,
    /// The point in the octave after the last one of those that are known.
    p: DVec3,
    some: [f64; TOGETHER],
    /// Those of `some` that have not been asked for.
    next: usize,
    end: usize,
    /// How many octaves are not known yet.
    left: usize,
}

impl Noises<'_> {
    #[inline(always)]
    fn next(&mut self) -> f64 {
        if self.next == self.end {
            self.go_on();
        }
        let noise = self.some[self.next % TOGETHER];
        self.next += 1;
        noise
    }

    #[inline(never)]
    fn go_on(&mut self) {
        let Octaves {
            lacunarity,
            generator,
            ..
        } = *self.of;
        let count = self.left.min(TOGETHER);
        store_octaves(&mut self.p, lacunarity, generator, &mut self.some[..count]);
        self.left -= count;
        (self.next, self.end) = (0, count);
    }
}

/// All that noise can be.
const FULL: Range = (0.0, 1.0);

/// Bounds of the noise of octave after octave over a box.
struct Ranges<'a> {
    of: &'a Octaves,
    /// The box in the octave after the last one of those that are known.
    area: [DVec3; 2],
    some: [Range; TOGETHER],
    /// Those of `some` that have not been asked for.
    next: usize,
    end: usize,
    /// How many octaves are not known yet.
    left: usize,
}

impl Ranges<'_> {
    /// `None` if noise can be anything in this octave and all others.
    #[inline(always)]
    fn next(&mut self) -> Option<Range> {
        if self.next == self.end && (self.left == 0 || !self.go_on()) {
            return None;
        }
        let range = self.some[self.next % TOGETHER];
        self.next += 1;
        Some(range)
    }

    #[inline(never)]
    fn go_on(&mut self) -> bool {
        let Octaves {
            lacunarity,
            generator,
            ..
        } = *self.of;
        let count = self.left.min(TOGETHER);
        let some = &mut self.some[..count];
        let known = store_octave_bounds(&mut self.area, lacunarity, generator, some);
        self.left = if known == count { self.left - count } else { 0 };
        (self.next, self.end) = (0, known);
        known > 0
    }

    fn noise(&mut self) -> Bounds {
        let (low, high) = self.next().unwrap_or(FULL);
        Bounds::new(low, high)
    }

    /// The same from -1 to 1.
    fn signed(&mut self) -> Bounds {
        super::fractal::signed(self.noise())
    }
}

#[cfg(test)]
mod tests;
