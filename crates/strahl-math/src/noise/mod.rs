//! Solid noise: a smooth pseudo-random function of space, its vector-valued sibling, and the sums over octaves that are
//! called turbulence.
//!
//! The functions are those of POV-Ray 3.7, so that a marble keeps its veins. Their construction and their tables were
//! measured on the running program: its `f_noise_generator` and `vturbulence` along the lattice's lines give values and
//! gradients of the corners exactly, and rows of lattice values that are XOR permutations (or shifts) of each other give
//! the hash up to one constant, which the requirement that every stage uses the same table fixes. The
//! largest difference was 2.3e-16, at 120,000 random points with coordinates up to 3e7 for generator 3, at 80,000 points up to
//! 2e4 for generators 1 and 2.
//!
//! Two constructions occur, both on the integer lattice, both blending the linear functions attached to the eight corners
//! of a cell by `s(t) = 3t² - 2t³` along each axis (so the gradient is continuous, the curvature is not):
//!
//! * *value-gradient noise* (generators 1 and 2, and [`dnoise`]): corner `(i, j, k)` is hashed to
//!   `h = H[H[H[i] ^ j] ^ k] & 255` through a permutation of 4096, and carries `r[h]/2 + (r[h+1], r[h+2], r[h+3]) · d`,
//!   where `d` points from the corner to the place: value and gradient overlap in one table `r`;
//! * *gradient noise* (generator 3; Perlin, "An Image Synthesizer", SIGGRAPH 1985): corner `(i, j, k)` carries `g · d`
//!   with a unit vector `g = G[p[p[i] + j] + k]` of 2048. Its lattice is shifted by 10000000.0231572, so that integers
//!   are not zeros of the function; the sum also rounds coordinates to 2⁻²⁹.
//!
//! The first repeats every 4096, the second every 2048 units.

mod bounds;
mod kernel;
mod plane;
#[cfg(test)]
mod random;
mod segment;
mod tables;

pub use bounds::{noise_bounds, noise_rate, store_octave_bounds};
pub use plane::{PlaneBounds, PlaneNoise, plane_noise, plane_noise_bounds};
pub use segment::{Along, LEAST_REACH, Segment, noise_along, store_octaves_along};

use crate::DVec3;
use strahl_simd::{Isa, Simd, dispatch};
use tables::{GRADIENTS, PERMUTATION, hash};

/// Which of the three scalar noise functions of POV-Ray 3.7 to use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum NoiseGenerator {
    /// `noise_generator 1`: value-gradient noise plus 1/2, cut off at 0 and 1 (which shows as plateaus).
    Original,
    /// `noise_generator 2`, the default: the same function, scaled so that it stays in `0..=1`.
    #[default]
    RangeCorrected,
    /// `noise_generator 3`: gradient noise.
    Perlin,
}

impl NoiseGenerator {
    /// The generator with POV-Ray's number 1, 2 or 3.
    pub const fn from_number(number: u32) -> Option<Self> {
        match number {
            1 => Some(Self::Original),
            2 => Some(Self::RangeCorrected),
            3 => Some(Self::Perlin),
            _ => None,
        }
    }
}

/// Scalar noise at `p`, `0..=1` with a mean near 1/2; NaN where a coordinate is not finite.
pub fn noise(p: DVec3, generator: NoiseGenerator) -> f64 {
    dispatch!(Simd::best(), isa => kernel::noise(isa, p, generator))
}

/// Stores [`noise`] at any number of points, whose coordinates are given axis by axis, with the same bits. The slices have the same length.
pub fn store_noise(points: [&[f64]; 3], generator: NoiseGenerator, values: &mut [f64]) {
    let [x, y, z] = points;
    dispatch!(Simd::best(), isa => {
        for (at, four) in values.chunks_mut(4).enumerate() {
            let from = 4 * at;
            if four.len() == 1 || generator == NoiseGenerator::Perlin {
                for (at, value) in four.iter_mut().enumerate() {
                    let p = DVec3::new(x[from + at], y[from + at], z[from + at]);
                    *value = kernel::noise(isa, p, generator);
                }
                continue;
            }
            let last = four.len() - 1;
            // The last point takes the lanes that are left.
            let at = [from, from + last.min(1), from + last.min(2), from + last];
            let points = [
                isa.load(&[x[at[0]], x[at[1]], x[at[2]], x[at[3]]]),
                isa.load(&[y[at[0]], y[at[1]], y[at[2]], y[at[3]]]),
                isa.load(&[z[at[0]], z[at[1]], z[at[2]], z[at[3]]]),
            ];
            let found = isa.store(kernel::noise_of_four(isa, points, generator));
            four.copy_from_slice(&found[..four.len()]);
        }
    });
}

/// Stores [`noise`] at points of which the first is `p` and each is the one before times `lacunarity`, with the same bits. `p` becomes the one
/// after the last.
pub fn store_octaves(
    p: &mut DVec3,
    lacunarity: f64,
    generator: NoiseGenerator,
    values: &mut [f64],
) {
    dispatch!(Simd::best(), isa => octaves_with(isa, p, lacunarity, generator, values));
}

#[inline(always)]
fn octaves_with<I: Isa>(
    isa: I,
    p: &mut DVec3,
    lacunarity: f64,
    generator: NoiseGenerator,
    values: &mut [f64],
) {
    let by = isa.splat(lacunarity);
    let mut point = isa.load(&[p.x, p.y, p.z, 0.0]);
    for four in values.chunks_mut(4) {
        // Two octaves take less time one by one.
        if four.len() < 3 || generator == NoiseGenerator::Perlin {
            for value in four {
                let [x, y, z, _] = isa.store(point);
                *value = kernel::noise(isa, DVec3::new(x, y, z), generator);
                point = isa.mul(point, by);
            }
            continue;
        }
        let mut points = [point; 4];
        for octave in 1..4 {
            points[octave] = isa.mul(points[octave - 1], by);
        }
        // The lanes that are left take the last one.
        if let &mut [_, _, _] = four {
            points[3] = points[2];
        }
        point = isa.mul(points[3], by);
        let [x, y, z, _] = isa.transpose(points);
        let found = isa.store(kernel::noise_of_four(isa, [x, y, z], generator));
        for (value, found) in four.iter_mut().zip(found) {
            *value = found;
        }
    }
    let [x, y, z, _] = isa.store(point);
    *p = DVec3::new(x, y, z);
}

/// [`noise`] at eight points, whose coordinates are given four by four and axis by axis, with the same bits. Points that are all in one cell of
/// the lattice, as those of which the differences are a gradient, take little more time than one.
pub fn noise_of_neighbours(
    points: &[[[f64; 4]; 3]; 2],
    generator: NoiseGenerator,
) -> [[f64; 4]; 2] {
    dispatch!(Simd::best(), isa => neighbours_with(isa, points, generator))
}

#[inline(always)]
fn neighbours_with<I: Isa>(
    isa: I,
    points: &[[[f64; 4]; 3]; 2],
    generator: NoiseGenerator,
) -> [[f64; 4]; 2] {
    let [[a, b, c], [d, e, f]] = points;
    let first = [isa.load(a), isa.load(b), isa.load(c)];
    let second = [isa.load(d), isa.load(e), isa.load(f)];
    let [p, q] = kernel::noise_of_neighbours(isa, [first, second], generator);
    [isa.store(p), isa.store(q)]
}

/// Vector noise at `p`: three independent value-gradient noises, each with a mean near zero and seldom beyond ±1.
///
/// The same for every [`NoiseGenerator`]; what turbulence displaces points by.
pub fn dnoise(p: DVec3) -> DVec3 {
    dispatch!(Simd::best(), isa => {
        let [x, y, z, _] = isa.store(kernel::vector(isa, isa.load(&[p.x, p.y, p.z, 0.0])));
        DVec3::new(x, y, z)
    })
}

/// Octaves of noise: each has `lambda` times the frequency and `omega` times the strength of the one before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turbulence {
    /// Number of octaves summed, `1..=10` in POV-Ray's language.
    pub octaves: u32,
    /// Ratio of the strength of successive octaves.
    pub omega: f64,
    /// Ratio of the frequency of successive octaves.
    pub lambda: f64,
}

impl Default for Turbulence {
    /// Six octaves, each of half the strength and twice the frequency.
    fn default() -> Self {
        Self {
            octaves: 6,
            omega: 0.5,
            lambda: 2.0,
        }
    }
}

impl Turbulence {
    /// The sum of `omega^i dnoise(lambda^i p)` over the octaves `i`.
    pub fn vector(&self, p: DVec3) -> DVec3 {
        self.vector_with(Simd::best(), p)
    }

    #[inline(always)]
    fn vector_with(&self, simd: Simd, p: DVec3) -> DVec3 {
        dispatch!(simd, isa => {
            let (mut frequency, mut strength) = (1.0, 1.0);
            let mut sum = isa.splat(0.0);
            let mut left = self.octaves;
            while left > 0 {
                let (mut frequencies, mut strengths) = ([0.0; 4], [0.0; 4]);
                for k in 0..4 {
                    (frequencies[k], strengths[k]) = (frequency, strength);
                    frequency *= self.lambda;
                    strength *= self.omega;
                }
                let count = left.min(4);
                sum = kernel::add_vectors(isa, p, frequencies, &strengths, count as usize, sum);
                left -= count;
            }
            let [x, y, z, _] = isa.store(sum);
            DVec3::new(x, y, z)
        })
    }

    /// The scalar sum of `omega^i n_i(lambda^i p)` over the octaves `i`, as marble and agate use it.
    ///
    /// `n_i` is [`noise`] with [`NoiseGenerator::Original`], and `2 noise - 1/2` with the others; of the latter only the
    /// first octave is cut off at 0 and 1 (measured).
    pub fn scalar(&self, p: DVec3, generator: NoiseGenerator) -> f64 {
        dispatch!(Simd::best(), isa => {
            let (mut frequency, mut strength) = (1.0, 1.0);
            let mut sum = 0.0;
            let mut left = self.octaves;
            let mut is_first = true;
            while left >= 3 {
                let (mut frequencies, mut strengths) = ([0.0; 4], [0.0; 4]);
                for k in 0..4 {
                    (frequencies[k], strengths[k]) = (frequency, strength);
                    frequency *= self.lambda;
                    strength *= self.omega;
                }
                let [mut a, b, c, d] = isa.store(four_stretched(isa, p, frequencies, generator));
                if is_first {
                    a = unit(a);
                    is_first = false;
                }
                sum = sum + a * strengths[0] + b * strengths[1] + c * strengths[2];
                if left == 3 {
                    return sum;
                }
                sum += d * strengths[3];
                left -= 4;
            }
            for _ in 0..left {
                let value = stretched(isa, p * frequency, generator);
                sum += if is_first { unit(value) } else { value } * strength;
                is_first = false;
                frequency *= self.lambda;
                strength *= self.omega;
            }
            sum
        })
    }
}

/// Octaves of noise as granite and wrinkles want it, octave `i` at `frequency` 2ⁱ `p`: with [`NoiseGenerator::Original`] the [`noise`] itself,
/// else `2 noise - 1/2`, cut off at 0 and 1, which has about the same distribution.
pub fn pattern_octaves<const N: usize>(
    p: DVec3,
    frequency: f64,
    generator: NoiseGenerator,
) -> [f64; N] {
    dispatch!(Simd::best(), isa => {
        let mut all = [0.0; N];
        let mut frequency = frequency;
        let (fours, rest) = all.as_chunks_mut();
        for four in fours {
            let frequencies = [frequency, 2.0 * frequency, 4.0 * frequency, 8.0 * frequency];
            *four = isa.store(four_stretched(isa, p, frequencies, generator));
            for value in four {
                *value = unit(*value);
            }
            frequency *= 16.0;
        }
        for value in rest {
            *value = unit(stretched(isa, p * frequency, generator));
            frequency *= 2.0;
        }
        all
    })
}

/// [`pattern_octaves`] at four points, whose coordinates are given axis by axis, with the same bits.
pub fn pattern_octaves_of_four<const N: usize>(
    points: &[[f64; 4]; 3],
    frequency: f64,
    generator: NoiseGenerator,
) -> [[f64; 4]; N] {
    dispatch!(Simd::best(), isa => {
        let (factor, shift) = stretch(generator);
        let [x, y, z] = points;
        let [x, y, z] = [isa.load(x), isa.load(y), isa.load(z)];
        let mut all = [[0.0; 4]; N];
        let mut frequency = frequency;
        for values in &mut all {
            let by = isa.splat(frequency);
            let points = [isa.mul(x, by), isa.mul(y, by), isa.mul(z, by)];
            let noise = kernel::noise_of_four(isa, points, generator);
            let noise = isa.sub(isa.mul(noise, isa.splat(factor)), isa.splat(shift));
            *values = isa.store(noise);
            for value in values {
                *value = unit(*value);
            }
            frequency *= 2.0;
        }
        all
    })
}

#[inline(always)]
fn stretched<I: Isa>(isa: I, p: DVec3, generator: NoiseGenerator) -> f64 {
    let (factor, shift) = stretch(generator);
    kernel::noise(isa, p, generator) * factor - shift
}

/// The same at a point times each of four frequencies.
#[inline(always)]
fn four_stretched<I: Isa>(
    isa: I,
    p: DVec3,
    frequencies: [f64; 4],
    generator: NoiseGenerator,
) -> I::F64x4 {
    let by = isa.load(&frequencies);
    let points = [
        isa.mul(isa.splat(p.x), by),
        isa.mul(isa.splat(p.y), by),
        isa.mul(isa.splat(p.z), by),
    ];
    let noise = kernel::noise_of_four(isa, points, generator);
    let (factor, shift) = stretch(generator);
    isa.sub(isa.mul(noise, isa.splat(factor)), isa.splat(shift))
}

/// What noise is multiplied by, and what is subtracted then. With the original noise that is nothing, which changes no bit.
#[inline(always)]
fn stretch(generator: NoiseGenerator) -> (f64, f64) {
    if generator == NoiseGenerator::Original {
        (1.0, 0.0)
    } else {
        (2.0, 0.5)
    }
}

/// The hash of a lattice cell, `0..4096`, by which cells are told apart in patterns that need a random number per cell.
///
/// It is the hash of the value-gradient noise without that noise's shift of the lattice; it repeats every 4096 cells.
#[inline]
pub fn lattice_hash(cell: [i64; 3]) -> usize {
    let [i, j, k] = each(cell, |c| (c & 4095) as usize);
    usize::from(hash(usize::from(hash(usize::from(hash(i)) ^ j)) ^ k))
}

/// `array::map`, which is not always inlined.
#[inline(always)]
fn each<A, B>([a, b, c]: [A; 3], f: impl Fn(A) -> B) -> [B; 3] {
    [f(a), f(b), f(c)]
}

/// `x` cut off at 0 and 1.
#[inline(always)]
fn unit(x: f64) -> f64 {
    x.clamp(0.0, 1.0)
}

/// `3t² - 2t³`.
#[inline(always)]
fn smooth(t: f64) -> f64 {
    t * t * (3.0 - 2.0 * t)
}

/// What the lattice of the gradient noise is shifted by. 12432434 · 2⁻²⁹ is what is left of the fraction .0231572 at this
/// magnitude; both terms are exact.
const SHIFT: f64 = 10_000_000.0 + 12_432_434.0 / 536_870_912.0;

/// The gradient at a corner of a cell, whose index is below 2048.
fn perlin_gradient(index: [usize; 3], step: [usize; 3]) -> DVec3 {
    let [i, j, k] = each([0, 1, 2], |a: usize| (index[a] + step[a]) & 2047);
    GRADIENTS[(perlin_row(i, j) + k) & 2047]
}

#[inline(always)]
fn perlin_row(i: usize, j: usize) -> usize {
    usize::from(PERMUTATION[(usize::from(PERMUTATION[i]) + j) & 2047])
}

#[cfg(test)]
mod tests;
