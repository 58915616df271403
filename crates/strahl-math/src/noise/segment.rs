//! What noise does along a segment, for proofs that a function has no zero on it or only one.
//!
//! On the piece of a segment that lies in one cell of the lattice, noise is a polynomial of degree ten in the parameter of the line: a share
//! `3u² - 2u³` of each axis, of degree three, and the linear function of a corner. Its coefficients in the Bernstein basis of the piece bound it,
//! and their differences bound its derivative; both close in on the true range with the square of the length (G. Farin, Curves and Surfaces
//! for CAGD, chapters 4 and 5). Boxes around the segment have bounds three to five times as wide.

use super::bounds::{Range, end, factor};
use super::kernel::{CELL_SHIFT, OVERFLOW, whole};
use super::tables::{CORNERS, hash};
use super::{NoiseGenerator, SHIFT, perlin_gradient};
use crate::DVec3;
use strahl_simd::{Isa, Simd, dispatch};

/// The points `middle + s reach` for `s` from -1 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Where `s` is zero.
    pub middle: DVec3,
    /// From there to the end.
    pub reach: DVec3,
}

impl Segment {
    /// The segment times a number.
    fn scaled(self, by: f64) -> Self {
        Self {
            middle: self.middle * by,
            reach: self.reach * by,
        }
    }
}

/// Bounds of noise on a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along {
    /// Of the noise.
    pub value: Range,
    /// Of its derivative by the segment's parameter `s`.
    pub rate: Range,
}

impl Along {
    /// What holds for all segments.
    pub const UNKNOWN: Self = Self {
        value: (0.0, 1.0),
        rate: (f64::NEG_INFINITY, f64::INFINITY),
    };

    /// Bounds of nothing.
    const NOTHING: Self = Self {
        value: (f64::INFINITY, f64::NEG_INFINITY),
        rate: (f64::INFINITY, f64::NEG_INFINITY),
    };
}

/// The degree of the polynomials.
const DEGREE: usize = 10;

/// How often each product of Bernstein polynomials occurs.
const BINOMIALS: [f64; DEGREE + 1] = [
    1.0, 10.0, 45.0, 120.0, 210.0, 252.0, 210.0, 120.0, 45.0, 10.0, 1.0,
];

/// Pieces are at least this part of the parameter's range: shorter ones are bounded together with what their polynomial does beyond them, or
/// their derivative would drown in rounding errors.
const SHORTEST: f64 = 0.0625;

/// Segments of less than this size have no [`Along`]: differences of their coefficients have too few digits. Boxes do as well there.
pub const LEAST_REACH: f64 = 1e-6;

/// Segments that meet one plane of the lattice along each axis are in so many cells.
const MOST: usize = 4;

/// Room for the pieces of several octaves: a multiple of four.
const ROOM: usize = 24;

/// More than the rounding errors of values and of differences of coefficients, whose terms are of the size of 1.
const ROUNDING: f64 = 1e-12;

/// Stores bounds of noise along segments of which the first is `segment` and each is the one before times `lacunarity`; those that reach
/// over more than one plane of the lattice along an axis, or beyond the range of 32-bit integers, have [`Along::UNKNOWN`]. All count by the
/// parameter of the first one. `segment` becomes the one after the last.
///
/// Points on the segments may be rounded by a few places of their last bits.
pub fn store_octaves_along(
    segment: &mut Segment,
    lacunarity: f64,
    generator: NoiseGenerator,
    octaves: &mut [Along],
) {
    dispatch!(Simd::best(), isa => octaves_along(isa, segment, lacunarity, generator, octaves));
}

/// Bounds of noise along one segment.
pub fn noise_along(mut segment: Segment, generator: NoiseGenerator) -> Along {
    let mut found = [Along::UNKNOWN];
    store_octaves_along(&mut segment, 1.0, generator, &mut found);
    found[0]
}

#[inline(always)]
pub(super) fn octaves_along<I: Isa>(
    isa: I,
    segment: &mut Segment,
    lacunarity: f64,
    generator: NoiseGenerator,
    octaves: &mut [Along],
) {
    let mut pieces = Pieces::new();
    let mut part = *segment;
    for octave in 0..octaves.len() {
        octaves[octave] = if pieces.add(octave, part, generator) {
            Along::NOTHING
        } else {
            Along::UNKNOWN
        };
        if pieces.count > ROOM - MOST {
            pieces.bound(isa, generator, octaves);
        }
        part = part.scaled(lacunarity);
    }
    pieces.bound(isa, generator, octaves);
    for octave in octaves {
        if octave.rate.1 < f64::INFINITY {
            *octave = noise_by_sum(*octave, *segment, generator);
        }
        *segment = segment.scaled(lacunarity);
    }
}

/// Bounds of noise by those of the sum over the corners.
#[inline(always)]
fn noise_by_sum(sum: Along, segment: Segment, generator: NoiseGenerator) -> Along {
    let size = |v: DVec3| v.x.abs() + v.y.abs() + v.z.abs();
    // How far rounding moves the points, of which those of the gradient noise are multiples of 2⁻²⁹ on their lattice.
    let off = match generator {
        NoiseGenerator::Perlin => 1e-8,
        _ => 64.0 * f64::EPSILON * size(segment.middle),
    };
    let pad = ROUNDING + 4.0 * off;
    let value = (
        end(sum.value.0, -pad, generator),
        end(sum.value.1, pad, generator),
    );
    let pad = ROUNDING + (ROUNDING + 16.0 * off) * size(segment.reach);
    let factor = factor(generator);
    let mut rate = (sum.rate.0 * factor - pad, sum.rate.1 * factor + pad);
    // Where noise is cut off it does not change.
    if value.0 <= 0.0 || value.1 >= 1.0 {
        rate = (rate.0.min(0.0), rate.1.max(0.0));
    }
    Along { value, rate }
}

/// The parts of segments that are each in one cell, an array for each number, so that four can be loaded at a time.
struct Pieces {
    count: usize,
    octaves: [usize; ROOM],
    /// The number of the cell, axis by axis.
    cells: [[f64; ROOM]; 3],
    /// Where the piece starts and ends within the cell, or a little outside.
    from: [[f64; ROOM]; 3],
    to: [[f64; ROOM]; 3],
    /// The degree of the polynomial by the range of the segment's parameter.
    per: [f64; ROOM],
}

impl Pieces {
    #[inline(always)]
    fn new() -> Self {
        Self {
            count: 0,
            octaves: [0; ROOM],
            cells: [[0.0; ROOM]; 3],
            from: [[0.0; ROOM]; 3],
            to: [[0.0; ROOM]; 3],
            per: [0.0; ROOM],
        }
    }

    /// Adds the pieces of a segment. Tells whether that is possible.
    #[inline(always)]
    fn add(&mut self, octave: usize, segment: Segment, generator: NoiseGenerator) -> bool {
        let shift = match generator {
            NoiseGenerator::Perlin => SHIFT,
            _ => 0.0,
        };
        let (middle, reach) = (segment.middle.to_array(), segment.reach.to_array());
        let (mut start, mut way) = ([0.0; 3], [0.0; 3]);
        let (mut cell, mut step) = ([0.0; 3], [0.0; 3]);
        // Where a plane is met along each axis; beyond the end if none is.
        let mut plane = [2.0; 3];
        let (mut is_near, mut pieces) = (true, 1);
        for axis in 0..3 {
            let (m, r) = (middle[axis] + shift, reach[axis]);
            let (a, b) = (m - r, m + r);
            start[axis] = a;
            way[axis] = r + r;
            cell[axis] = a.floor();
            step[axis] = b.floor() - cell[axis];
            // Also refuses NaN.
            is_near &= a.abs() < OVERFLOW && b.abs() < OVERFLOW && step[axis].abs() <= 1.0;
            let is_met = step[axis] != 0.0;
            let upper = more(step[axis], 0.0);
            let at = (cell[axis] + upper - a) / (r + r);
            plane[axis] = if is_met { at } else { 2.0 };
            pieces += usize::from(is_met);
        }
        if !is_near {
            return false;
        }
        let [x, y, z] = plane;
        let (near, far) = (less(x, y), more(x, y));
        let (first, middle) = (less(near, z), more(near, z));
        let ends = [0.0, first, less(middle, far), more(middle, far), 1.0];
        for piece in 0..pieces {
            let from = ends[piece];
            let to = if piece + 1 == pieces {
                1.0
            } else {
                ends[piece + 1]
            };
            self.push(octave, (start, way), (cell, step, plane), (from, to));
        }
        true
    }

    /// Adds the piece between two parameters of a segment that starts in a cell and steps into the next one where it meets a plane.
    #[inline(always)]
    fn push(
        &mut self,
        octave: usize,
        (start, way): ([f64; 3], [f64; 3]),
        (cell, step, plane): ([f64; 3], [f64; 3], [f64; 3]),
        (from, to): (f64, f64),
    ) {
        // Longer at its end, or at its start if that is where the segment ends.
        let longer = more(to, from + SHORTEST);
        let over = more(longer - 1.0, 0.0);
        let (first, last) = (from - over, longer - over);
        let at = self.count % ROOM;
        for axis in 0..3 {
            let cell = cell[axis] + if plane[axis] <= from { step[axis] } else { 0.0 };
            let origin = start[axis] - cell;
            self.from[axis][at] = origin + first * way[axis];
            self.to[axis][at] = origin + last * way[axis];
            self.cells[axis][at] = cell;
        }
        self.octaves[at] = octave;
        self.per[at] = 0.5 * DEGREE as f64 / (last - first);
        self.count += 1;
    }

    /// Bounds all pieces and removes them.
    #[inline(always)]
    fn bound<I: Isa>(&mut self, isa: I, generator: NoiseGenerator, octaves: &mut [Along]) {
        for first in (0..self.count).step_by(4) {
            let [low, high, fall, rise] = self.bounds_of_four(isa, first, generator);
            for (lane, piece) in (first..self.count.min(first + 4)).enumerate() {
                let per = self.per[piece];
                let Along { value, rate } = &mut octaves[self.octaves[piece]];
                *value = (less(value.0, low[lane]), more(value.1, high[lane]));
                *rate = (
                    less(rate.0, per * fall[lane]),
                    more(rate.1, per * rise[lane]),
                );
            }
        }
        self.count = 0;
    }

    /// Bounds of the sums over the corners on four pieces: the least and the largest coefficient, and the least and the largest difference of
    /// neighbours, a lane for each piece.
    #[inline(always)]
    fn bounds_of_four<I: Isa>(
        &self,
        isa: I,
        first: usize,
        generator: NoiseGenerator,
    ) -> [[f64; 4]; 4] {
        let one = isa.splat(1.0);
        let mut is_flat = [false; 3];
        let (mut ways, mut shares) = ([[[one; 2]; 2]; 3], [[[one; 4]; 2]; 3]);
        for axis in 0..3 {
            let a = isa.load(four(&self.from[axis], first));
            let b = isa.load(four(&self.to[axis], first));
            let furthest = isa.max(isa.abs(a), isa.abs(b));
            is_flat[axis] = isa.le(furthest, isa.splat(0.0)) == 0b1111;
            ways[axis] = [[a, b], [isa.sub(a, one), isa.sub(b, one)]];
            shares[axis] = share_along(isa, a, b);
        }
        let gradients: [[[f64; 4]; 8]; 4];
        let rows: [[&[f64; 4]; 8]; 4] = if generator == NoiseGenerator::Perlin {
            gradients = std::array::from_fn(|lane| self.gradients(first + lane));
            gradients.each_ref().map(|corners| corners.each_ref())
        } else {
            [
                self.corners(first),
                self.corners(first + 1),
                self.corners(first + 2),
                self.corners(first + 3),
            ]
        };
        // Terrains are cuts through noise along a plane of its lattice, where corners beyond the plane have no share.
        let sides = [0, 1, 2].map(|axis: usize| 2 - usize::from(is_flat[axis]));
        let mut total = [isa.splat(0.0); DEGREE + 1];
        for i in 0..sides[0] {
            let mut row = [isa.splat(0.0); 8];
            for j in 0..sides[1] {
                let mut column = [isa.splat(0.0); 5];
                for k in 0..sides[2] {
                    let [value, x, y, z] = isa.load_columns([
                        rows[0][4 * i + 2 * j + k],
                        rows[1][4 * i + 2 * j + k],
                        rows[2][4 * i + 2 * j + k],
                        rows[3][4 * i + 2 * j + k],
                    ]);
                    let mut linear = [value; 2];
                    for side in 0..2 {
                        let x = isa.mul(x, ways[0][i][side]);
                        let y = isa.mul(y, ways[1][j][side]);
                        let z = isa.mul(z, ways[2][k][side]);
                        linear[side] = isa.add(value, isa.add(isa.add(x, y), z));
                    }
                    add_product(isa, &mut column, &linear, &shares[2][k]);
                }
                add_product(isa, &mut row, &column, &shares[1][j]);
            }
            add_product(isa, &mut total, &row, &shares[0][i]);
        }
        for (coefficient, times) in total.iter_mut().zip(BINOMIALS) {
            *coefficient = isa.mul(*coefficient, isa.splat(1.0 / times));
        }
        let (mut low, mut high) = (total[0], total[0]);
        let first = isa.sub(total[1], total[0]);
        let (mut fall, mut rise) = (first, first);
        for n in 1..=DEGREE {
            low = isa.min(low, total[n]);
            high = isa.max(high, total[n]);
            let step = isa.sub(total[n], total[n - 1]);
            fall = isa.min(fall, step);
            rise = isa.max(rise, step);
        }
        [
            isa.store(low),
            isa.store(high),
            isa.store(fall),
            isa.store(rise),
        ]
    }

    /// The values and gradients of the corners of a piece's cell; corner `4 i + 2 j + k` is the lower or the upper one along x, y and z.
    #[inline(always)]
    fn corners(&self, piece: usize) -> [&'static [f64; 4]; 8] {
        let mut all = [&CORNERS.0[0]; 8];
        let number = |axis: usize| whole(self.cells[axis][piece]) + CELL_SHIFT as usize;
        let (x, y, z) = (number(0), number(1), number(2));
        for i in 0..2 {
            let row = usize::from(hash(x + i));
            for j in 0..2 {
                let column = usize::from(hash(row ^ (y + j)));
                for k in 0..2 {
                    let h = usize::from(hash(column ^ (z + k)) & 255);
                    all[4 * i + 2 * j + k] = &CORNERS.0[h];
                }
            }
        }
        all
    }

    /// The same of the gradient noise, whose corners have no values.
    fn gradients(&self, piece: usize) -> [[f64; 4]; 8] {
        let number = |axis: usize| whole(self.cells[axis][piece]) & 2047;
        let cell = [number(0), number(1), number(2)];
        std::array::from_fn(|n| {
            let g = perlin_gradient(cell, [n >> 2, n >> 1 & 1, n & 1]);
            [0.0, g.x, g.y, g.z]
        })
    }
}

/// Four numbers of a row.
#[inline(always)]
fn four(row: &[f64; ROOM], first: usize) -> &[f64; 4] {
    row[first..].first_chunk().unwrap_or(&[0.0; 4])
}

#[inline(always)]
fn less(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline(always)]
fn more(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The share of the lower and of the upper side of a blend along an axis, `1 - s` and `s` with `s = 3u² - 2u³`, where `u` goes from `a` to
/// `b`: its coefficients in the Bernstein basis, each as often as its polynomial occurs.
#[inline(always)]
fn share_along<I: Isa>(isa: I, a: I::F64x4, b: I::F64x4) -> [[I::F64x4; 4]; 2] {
    let (one, two, three) = (isa.splat(1.0), isa.splat(2.0), isa.splat(3.0));
    let (aa, ab, bb) = (isa.mul(a, a), isa.mul(a, b), isa.mul(b, b));
    let twice = |x| isa.mul(two, x);
    // The polar form of s: uv + uw + vw - 2uvw (ibid., chapter 3).
    let ends = [
        isa.mul(aa, isa.sub(three, twice(a))),
        isa.mul(bb, isa.sub(three, twice(b))),
    ];
    let near = isa.sub(isa.add(aa, twice(ab)), twice(isa.mul(aa, b)));
    let far = isa.sub(isa.add(bb, twice(ab)), twice(isa.mul(bb, a)));
    let upper = [ends[0], isa.mul(three, near), isa.mul(three, far), ends[1]];
    let lower = [
        isa.sub(one, upper[0]),
        isa.sub(three, upper[1]),
        isa.sub(three, upper[2]),
        isa.sub(one, upper[3]),
    ];
    [lower, upper]
}

/// Adds the product of two polynomials whose coefficients are counted as often as their Bernstein polynomials occur.
#[inline(always)]
fn add_product<I: Isa, const A: usize, const S: usize>(
    isa: I,
    sum: &mut [I::F64x4; S],
    a: &[I::F64x4; A],
    b: &[I::F64x4; 4],
) {
    for i in 0..A {
        for j in 0..4 {
            sum[i + j] = isa.add(sum[i + j], isa.mul(a[i], b[j]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{noise, noise_rate, random::Random};
    use super::*;

    const GENERATORS: [NoiseGenerator; 3] = [
        NoiseGenerator::Original,
        NoiseGenerator::RangeCorrected,
        NoiseGenerator::Perlin,
    ];

    fn segment(random: &mut Random, size: f64) -> Segment {
        let mut around = || random.cube() * 2.0 - DVec3::ONE;
        let (mut reach, mut middle) = (around() * size, around() * 30.0);
        match (random.unit() * 8.0) as u32 {
            0 => reach.x = 0.0,
            1 => reach = DVec3::new(0.0, reach.y, 0.0),
            _ => {}
        }
        if random.unit() < 0.1 {
            middle = middle.round();
        }
        Segment { middle, reach }
    }

    #[test]
    fn bounds_hold_and_close_in_on_the_noise() {
        let mut random = Random(1);
        for generator in GENERATORS {
            for size in [1.2, 0.45, 0.1, 0.01, 1e-4, LEAST_REACH] {
                let (mut known, mut narrower, mut wide) = (0, 0, 0.0);
                // The places of the gradient noise are rounded more than the others.
                let (room, pad) = match generator {
                    NoiseGenerator::Perlin => (2e-8, 9e-8),
                    _ => (1e-13, 1e-10),
                };
                for _ in 0..600 {
                    let part = segment(&mut random, size);
                    let along = noise_along(part, generator);
                    if along == Along::UNKNOWN {
                        continue;
                    }
                    known += 1;
                    let is_cut = along.value.0 <= 0.0 || along.value.1 >= 1.0;
                    let at = |s: f64| noise(part.middle + part.reach * s, generator);
                    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
                    for _ in 0..20 {
                        let (a, b) = (2.0 * random.unit() - 1.0, 2.0 * random.unit() - 1.0);
                        let (p, q) = (at(a), at(b));
                        assert!(along.value.0 <= p && p <= along.value.1, "{p} {along:?}");
                        let (x, y) = ((b - a) * along.rate.0, (b - a) * along.rate.1);
                        let change = q - p;
                        assert!(
                            x.min(y) - room <= change && change <= x.max(y) + room,
                            "{generator:?} {part:?} {change} {along:?}"
                        );
                        (low, high) = (low.min(p).min(q), high.max(p).max(q));
                    }
                    let (from, to) = (part.middle - part.reach, part.middle + part.reach);
                    let way = part.reach.to_array().map(|r| (r, r));
                    let (_, boxed) = noise_rate(from.min(to), from.max(to), &way, generator);
                    narrower += u32::from(along.rate.1 - along.rate.0 < 0.7 * (boxed.1 - boxed.0));
                    if !is_cut {
                        wide += (along.value.1 - along.value.0 - pad) / (high - low).max(1e-12);
                    }
                }
                assert!(known > if size > 1.0 { 100 } else { 500 }, "{known}");
                // Twenty points do not show the whole range.
                assert!(wide < 1.6 * f64::from(known), "{generator:?} {size} {wide}");
                assert!(
                    size < 1e-3 || narrower > known * 3 / 4,
                    "{generator:?} {size} {narrower}"
                );
            }
        }
    }

    #[test]
    fn octaves_are_those_of_multiples_with_the_same_bits_everywhere() {
        let mut random = Random(2);
        for generator in GENERATORS {
            for _ in 0..200 {
                let part = segment(&mut random, 0.05);
                let lacunarity = 3.0 * random.unit();
                let mut found = [Along::UNKNOWN; 7];
                let mut last = part;
                store_octaves_along(&mut last, lacunarity, generator, &mut found);
                let mut other = part;
                for octave in found {
                    assert_eq!(octave, noise_along(other, generator));
                    other = other.scaled(lacunarity);
                }
                assert_eq!(last, other);
                for simd in Simd::available() {
                    let mut same = [Along::UNKNOWN; 7];
                    let mut other = part;
                    dispatch!(simd, isa => {
                        octaves_along(isa, &mut other, lacunarity, generator, &mut same);
                    });
                    assert_eq!(same, found, "{simd:?}");
                }
            }
        }
    }

    #[test]
    fn long_and_strange_segments_are_unknown() {
        for (middle, reach) in [
            (DVec3::ZERO, DVec3::splat(2.2)),
            (DVec3::splat(f64::NAN), DVec3::ONE),
            (DVec3::splat(f64::INFINITY), DVec3::ZERO),
            (DVec3::splat(3e9), DVec3::splat(0.1)),
        ] {
            for generator in GENERATORS {
                assert_eq!(
                    noise_along(Segment { middle, reach }, generator),
                    Along::UNKNOWN
                );
            }
        }
    }
}
