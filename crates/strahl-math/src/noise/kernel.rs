//! Noise at a point, for the vectors of one level.

use super::tables::{CORNERS, GRADIENTS, SPREAD, hash};
use super::{NoiseGenerator, SHIFT, perlin_row, smooth, unit};
use crate::DVec3;
use strahl_simd::{Isa, Level, Portable};

/// The offset of cell 0 in the lattice of the value-gradient noise.
pub(super) const CELL_SHIFT: u32 = 10_000;

/// Numbers below it have room for a fraction of two bits.
const LARGE: f64 = 2_251_799_813_685_248.0; // 2^51

/// From here on, coordinates are beyond the range of 32-bit integers.
pub(super) const OVERFLOW: f64 = 2_147_483_648.0; // 2^31

/// As the conversion to an integer on x86 processors has it, which POV-Ray shows: the cell is the smallest integer, and the
/// position is far outside of it, so that noise is 0 or 1 (measured).
#[cold]
fn overflowed(x: f64) -> (u32, f64) {
    (1 << 31, x + OVERFLOW)
}

/// The lattice cell of a coordinate, modulo 2³², and the position within the cell. NaN has a NaN for a position, infinities have an
/// infinite one.
#[inline(always)]
fn place<I: Isa>(x: f64) -> (u32, f64) {
    if x.abs() >= OVERFLOW {
        return overflowed(x);
    }
    let floor = floor::<I>(x);
    // The lowest bits of the sum are those of the integer.
    ((floor + 3.0 * LARGE).to_bits() as u32, x - floor)
}

/// The greatest integer that is not above a number below [`OVERFLOW`].
#[inline(always)]
pub(super) fn floor<I: Isa>(x: f64) -> f64 {
    // The sum with a number below 2^51 has no bits for a fraction.
    if I::LEVEL >= Level::Sse4 {
        return x.floor();
    }
    // Without an instruction for it.
    let nearest = (x + 3.0 * LARGE) - 3.0 * LARGE;
    nearest - if nearest > x { 1.0 } else { 0.0 }
}

/// A whole number within the range of 32-bit integers, modulo 2^20: more than the lattices have until they repeat.
#[inline(always)]
pub(super) fn whole(x: f64) -> usize {
    // The sum with a number below 2^52 ends in the bits of the integer.
    (x + 3.0 * LARGE).to_bits() as usize & 0xf_ffff
}

/// From the lower and the upper corners to a position within a cell, along one axis.
#[inline(always)]
fn ways(position: f64) -> [f64; 2] {
    [position, position - 1.0]
}

/// The weights of the lower and the upper corners.
#[inline(always)]
fn shares(position: f64) -> [f64; 2] {
    let s = smooth(position);
    [1.0 - s, s]
}

/// Where a point is in the lattice of the value-gradient noise.
struct Cell<V> {
    /// The numbers of the lower and the upper corners along each axis, to be taken modulo 4096.
    numbers: [[usize; 2]; 3],
    /// The position within the cell. The last lane means nothing.
    position: V,
}

/// The cell of a point, whose coordinates are the first three lanes; the last lane is 0.
#[inline(always)]
fn cell<I: Isa>(isa: I, p: I::F64x4) -> Cell<I::F64x4> {
    let (numbers, position);
    if isa.lt(isa.abs(p), isa.splat(OVERFLOW)) == 0b1111 {
        let floor = isa.floor(p);
        // The lowest bits of the sum are those of the integer.
        let shifted = isa.add(floor, isa.splat(3.0 * LARGE + f64::from(CELL_SHIFT)));
        numbers = isa.store(shifted);
        position = isa.sub(p, floor);
    } else {
        let (cells, positions) = far_cell(isa.store(p));
        (numbers, position) = (cells, isa.load(&positions));
    }
    let [x, y, z] = [
        numbers[0].to_bits() as usize,
        numbers[1].to_bits() as usize,
        numbers[2].to_bits() as usize,
    ];
    Cell {
        numbers: [[x, x + 1], [y, y + 1], [z, z + 1]],
        position,
    }
}

/// The same for coordinates of any size: numbers whose lowest bits are those of the cell, and the position within it.
#[cold]
#[inline(never)]
fn far_cell(p: [f64; 4]) -> ([f64; 4], [f64; 4]) {
    let (mut cells, mut positions) = ([0.0; 4], [0.0; 4]);
    for axis in 0..3 {
        let (cell, position) = place::<Portable>(p[axis]);
        cells[axis] = f64::from_bits(u64::from(cell.wrapping_add(CELL_SHIFT)));
        positions[axis] = position;
    }
    (cells, positions)
}

impl<V> Cell<V> {
    /// The hash of the corners with these numbers along x and y.
    #[inline(always)]
    fn column(&self, i: usize, j: usize) -> usize {
        usize::from(hash(
            usize::from(hash(self.numbers[0][i])) ^ self.numbers[1][j],
        ))
    }

    /// The number of a corner in the table of values and gradients.
    #[inline(always)]
    fn corner(&self, column: usize, k: usize) -> usize {
        usize::from(hash(column ^ self.numbers[2][k]) & 255)
    }
}

/// `3t² - 2t³` in each lane.
#[inline(always)]
pub(super) fn smooth_lanes<I: Isa>(isa: I, t: I::F64x4) -> I::F64x4 {
    let slope = isa.sub(isa.splat(3.0), isa.mul(isa.splat(2.0), t));
    isa.mul(isa.mul(t, t), slope)
}

/// What is added to the scalar noise, and what the sum is multiplied by.
#[inline(always)]
fn scale(generator: NoiseGenerator) -> (f64, f64) {
    match generator {
        NoiseGenerator::RangeCorrected => (1.05242, 0.48985582),
        _ => (0.5, 1.0),
    }
}

/// [`noise`](super::noise).
#[inline(always)]
pub(super) fn noise<I: Isa>(isa: I, p: DVec3, generator: NoiseGenerator) -> f64 {
    if generator == NoiseGenerator::Perlin {
        return unit(0.4925 + 0.795 * perlin::<I>(p));
    }
    let (add, factor) = scale(generator);
    unit((scalar(isa, p) + add) * factor)
}

/// The scalar noise, with a mean near zero: the sum over the corners, in their order, of weight times `v/2 + g · way`.
#[inline(always)]
fn scalar<I: Isa>(isa: I, p: DVec3) -> f64 {
    let one = isa.splat(1.0);
    let c = cell(isa, isa.load(&[p.x, p.y, p.z, 0.0]));
    let (low, high) = (isa.store(c.position), isa.store(isa.sub(c.position, one)));
    let smooth = smooth_lanes(isa, c.position);
    let (less, more) = (isa.store(isa.sub(one, smooth)), isa.store(smooth));
    let dx = [low[0], high[0]];
    let dy = isa.load(&[low[1], low[1], high[1], high[1]]);
    let dz = isa.load(&[low[2], high[2], low[2], high[2]]);
    let sx = [less[0], more[0]];
    let sy = isa.load(&[less[1], less[1], more[1], more[1]]);
    let sz = isa.load(&[less[2], more[2], less[2], more[2]]);
    let mut sum = 0.0;
    for i in 0..2 {
        // Four corners at once.
        let (a, b) = (c.column(i, 0), c.column(i, 1));
        let [value, x, y, z] = isa.load_columns([
            &CORNERS.0[c.corner(a, 0)],
            &CORNERS.0[c.corner(a, 1)],
            &CORNERS.0[c.corner(b, 0)],
            &CORNERS.0[c.corner(b, 1)],
        ]);
        let x = isa.mul(x, isa.splat(dx[i]));
        let (y, z) = (isa.mul(y, dy), isa.mul(z, dz));
        let linear = isa.add(value, isa.add(isa.add(x, y), z));
        let share = isa.mul(isa.mul(isa.splat(sx[i]), sy), sz);
        let [a, b, c, d] = isa.store(isa.mul(share, linear));
        sum = sum + a + b + c + d;
    }
    sum
}

/// [`noise`] at four points, whose coordinates are given axis by axis, with the same bits.
#[inline(always)]
pub(super) fn noise_of_four<I: Isa>(
    isa: I,
    points: [I::F64x4; 3],
    generator: NoiseGenerator,
) -> I::F64x4 {
    let [x, y, z] = points;
    let near = isa.lt(farthest(isa, points), isa.splat(OVERFLOW)) == 0b1111;
    if !near || generator == NoiseGenerator::Perlin {
        let points = [isa.store(x), isa.store(y), isa.store(z)];
        return isa.load(&one_by_one(isa, &points, generator));
    }
    let (add, factor) = scale(generator);
    let sum = scalar_of_four(isa, points);
    let value = isa.mul(isa.add(sum, isa.splat(add)), isa.splat(factor));
    isa.min(isa.max(value, isa.splat(0.0)), isa.splat(1.0))
}

/// [`noise_of_four`] at twice as many points, which take little more time than one if all are in the same cell.
#[inline(always)]
pub(super) fn noise_of_neighbours<I: Isa>(
    isa: I,
    points: [[I::F64x4; 3]; 2],
    generator: NoiseGenerator,
) -> [I::F64x4; 2] {
    let far = isa.splat(OVERFLOW);
    let mut together = 0b1111;
    let mut cell = [0.0; 3];
    for half in points {
        together &= isa.lt(farthest(isa, half), far);
    }
    for axis in 0..3 {
        let floor = isa.floor(points[0][axis]);
        cell[axis] = isa.store(floor)[0];
        let first = isa.splat(cell[axis]);
        let other = isa.floor(points[1][axis]);
        together &= isa.le(floor, first) & isa.le(first, floor);
        together &= isa.le(other, first) & isa.le(first, other);
    }
    if together != 0b1111 || generator == NoiseGenerator::Perlin {
        let [a, b] = points;
        return [
            noise_of_four(isa, a, generator),
            noise_of_four(isa, b, generator),
        ];
    }
    let (add, factor) = scale(generator);
    let mut values = scalar_in_cell(isa, points, cell);
    for value in &mut values {
        let noise = isa.mul(isa.add(*value, isa.splat(add)), isa.splat(factor));
        *value = isa.min(isa.max(noise, isa.splat(0.0)), isa.splat(1.0));
    }
    values
}

/// [`scalar_of_four`] at points that are all in this cell.
#[inline(always)]
fn scalar_in_cell<I: Isa>(isa: I, points: [[I::F64x4; 3]; 2], cell: [f64; 3]) -> [I::F64x4; 2] {
    let (zero, one) = (isa.splat(0.0), isa.splat(1.0));
    let mut numbers = [0; 3];
    let mut ways = [[[one; 2]; 3]; 2];
    let mut shares = [[[one; 2]; 3]; 2];
    for axis in 0..3 {
        // As in `cell`.
        let shifted = cell[axis] + (3.0 * LARGE + f64::from(CELL_SHIFT));
        numbers[axis] = shifted.to_bits() as usize;
        for half in 0..2 {
            let t = isa.sub(points[half][axis], isa.splat(cell[axis]));
            ways[half][axis] = [t, isa.sub(t, one)];
            let upper = smooth_lanes(isa, t);
            shares[half][axis] = [isa.sub(one, upper), upper];
        }
    }
    let mut sums = [zero; 2];
    for i in 0..2 {
        let row = usize::from(hash(numbers[0] + i));
        for j in 0..2 {
            let column = usize::from(hash(row ^ (numbers[1] + j)));
            for k in 0..2 {
                let h = usize::from(hash(column ^ (numbers[2] + k)) & 255);
                let [value, x, y, z] = CORNERS.0[h];
                for half in 0..2 {
                    let (way, share) = (&ways[half], &shares[half]);
                    let x = isa.mul(isa.splat(x), way[0][i]);
                    let y = isa.mul(isa.splat(y), way[1][j]);
                    let z = isa.mul(isa.splat(z), way[2][k]);
                    let linear = isa.add(isa.splat(value), isa.add(isa.add(x, y), z));
                    let share = isa.mul(isa.mul(share[0][i], share[1][j]), share[2][k]);
                    sums[half] = isa.add(sums[half], isa.mul(share, linear));
                }
            }
        }
    }
    sums
}

/// At least the size of the largest coordinate in each lane; NaN where one of them is.
#[inline(always)]
fn farthest<I: Isa>(isa: I, [x, y, z]: [I::F64x4; 3]) -> I::F64x4 {
    // A maximum would lose a NaN.
    let sum = isa.add(isa.abs(x), isa.abs(y));
    isa.add(sum, isa.abs(z))
}

#[inline(never)]
fn one_by_one<I: Isa>(isa: I, points: &[[f64; 4]; 3], generator: NoiseGenerator) -> [f64; 4] {
    let mut values = [0.0; 4];
    for lane in 0..4 {
        let p = DVec3::new(points[0][lane], points[1][lane], points[2][lane]);
        values[lane] = noise(isa, p, generator);
    }
    values
}

/// [`scalar`] at four points, a lane for each, whose coordinates are numbers below [`OVERFLOW`].
#[inline(always)]
fn scalar_of_four<I: Isa>(isa: I, points: [I::F64x4; 3]) -> I::F64x4 {
    let (zero, one) = (isa.splat(0.0), isa.splat(1.0));
    let mut numbers = [[0.0; 4]; 3];
    let mut ways = [[one; 2]; 3];
    let mut shares = [[one; 2]; 3];
    for axis in 0..3 {
        let floor = isa.floor(points[axis]);
        // As in `cell`.
        let shifted = isa.add(floor, isa.splat(3.0 * LARGE + f64::from(CELL_SHIFT)));
        numbers[axis] = isa.store(shifted);
        let t = isa.sub(points[axis], floor);
        ways[axis] = [t, isa.sub(t, one)];
        let upper = smooth_lanes(isa, t);
        shares[axis] = [isa.sub(one, upper), upper];
    }
    let mut corners = [[0u8; 4]; 8];
    for lane in 0..4 {
        let [i, j, k] = [
            numbers[0][lane].to_bits() as usize,
            numbers[1][lane].to_bits() as usize,
            numbers[2][lane].to_bits() as usize,
        ];
        for a in 0..2 {
            let row = usize::from(hash(i + a));
            for b in 0..2 {
                let column = usize::from(hash(row ^ (j + b)));
                for c in 0..2 {
                    corners[4 * a + 2 * b + c][lane] = hash(column ^ (k + c)) as u8;
                }
            }
        }
    }
    let mut sum = zero;
    for i in 0..2 {
        for j in 0..2 {
            let share = isa.mul(shares[0][i], shares[1][j]);
            for k in 0..2 {
                let n = &corners[4 * i + 2 * j + k];
                let [value, x, y, z] = isa.load_columns([
                    &CORNERS.0[usize::from(n[0])],
                    &CORNERS.0[usize::from(n[1])],
                    &CORNERS.0[usize::from(n[2])],
                    &CORNERS.0[usize::from(n[3])],
                ]);
                let (x, y) = (isa.mul(x, ways[0][i]), isa.mul(y, ways[1][j]));
                let z = isa.mul(z, ways[2][k]);
                let linear = isa.add(value, isa.add(isa.add(x, y), z));
                sum = isa.add(sum, isa.mul(isa.mul(share, shares[2][k]), linear));
            }
        }
    }
    sum
}

/// The vector noise at a point, whose coordinates are the first three lanes; the last lane is 0, there and in the result.
///
/// The sum over the corners, in their order, of weight times `v/2 + g · way`. Twice the latter times half the weight has the same bits.
#[inline(always)]
pub(super) fn vector<I: Isa>(isa: I, p: I::F64x4) -> I::F64x4 {
    let c = cell(isa, p);
    let one = isa.splat(1.0);
    let twice = isa.add(c.position, c.position);
    let ways = [isa.store(twice), isa.store(isa.sub(twice, isa.splat(2.0)))];
    let smooth = smooth_lanes(isa, c.position);
    let (less, more) = (isa.store(isa.sub(one, smooth)), isa.store(smooth));
    let sx = isa.load(&[less[0], less[0], more[0], more[0]]);
    let sy = isa.load(&[less[1], more[1], less[1], more[1]]);
    let sxy = isa.mul(isa.mul(sx, sy), isa.splat(0.5));
    let shares = [
        isa.store(isa.mul(sxy, isa.splat(less[2]))),
        isa.store(isa.mul(sxy, isa.splat(more[2]))),
    ];
    let mut sum = isa.splat(0.0);
    for i in 0..2 {
        for j in 0..2 {
            let column = c.column(i, j);
            for k in 0..2 {
                let h = c.corner(column, k);
                let x = isa.mul(isa.load(&SPREAD.0[h + 1]), isa.splat(ways[i][0]));
                let y = isa.mul(isa.load(&SPREAD.0[h + 2]), isa.splat(ways[j][1]));
                let z = isa.mul(isa.load(&SPREAD.0[h + 3]), isa.splat(ways[k][2]));
                let twice = isa.add(isa.load(&SPREAD.0[h]), isa.add(isa.add(x, y), z));
                let share = isa.splat(shares[k][2 * i + j]);
                sum = isa.add(sum, isa.mul(twice, share));
            }
        }
    }
    sum
}

/// The sum of `strength · vector(frequency · p)` over four octaves or less, added to a sum.
#[inline(always)]
pub(super) fn add_vectors<I: Isa>(
    isa: I,
    p: DVec3,
    frequencies: [f64; 4],
    strengths: &[f64; 4],
    count: usize,
    sum: I::F64x4,
) -> I::F64x4 {
    let count = count.min(4);
    let (one, two) = (isa.splat(1.0), isa.splat(2.0));
    let by = isa.load(&frequencies);
    let points = [
        isa.mul(isa.splat(p.x), by),
        isa.mul(isa.splat(p.y), by),
        isa.mul(isa.splat(p.z), by),
    ];
    let near = isa.lt(farthest(isa, points), isa.splat(OVERFLOW));
    if near != 0b1111 {
        let points = [
            isa.store(points[0]),
            isa.store(points[1]),
            isa.store(points[2]),
        ];
        let sum = isa.store(sum);
        return isa.load(&add_far_vectors(&points, strengths, count, sum));
    }
    let mut sum = sum;
    let mut numbers = [[0.0; 4]; 3];
    let mut ways = [[[0.0; 4]; 2]; 3];
    let mut halves = [[one; 2]; 3];
    for axis in 0..3 {
        let floor = isa.floor(points[axis]);
        // As in `cell`.
        let shifted = isa.add(floor, isa.splat(3.0 * LARGE + f64::from(CELL_SHIFT)));
        numbers[axis] = isa.store(shifted);
        let t = isa.sub(points[axis], floor);
        let twice = isa.add(t, t);
        ways[axis] = [isa.store(twice), isa.store(isa.sub(twice, two))];
        let upper = smooth_lanes(isa, t);
        halves[axis] = [isa.sub(one, upper), upper];
    }
    let mut shares = [[0.0; 4]; 8];
    for i in 0..2 {
        for j in 0..2 {
            let share = isa.mul(isa.mul(halves[0][i], halves[1][j]), isa.splat(0.5));
            for k in 0..2 {
                shares[4 * i + 2 * j + k] = isa.store(isa.mul(share, halves[2][k]));
            }
        }
    }
    for lane in 0..count {
        let [x, y, z] = [
            numbers[0][lane].to_bits() as usize,
            numbers[1][lane].to_bits() as usize,
            numbers[2][lane].to_bits() as usize,
        ];
        let mut octave = isa.splat(0.0);
        for i in 0..2 {
            let row = usize::from(hash(x + i));
            let dx = isa.splat(ways[0][i][lane]);
            for j in 0..2 {
                let column = usize::from(hash(row ^ (y + j)));
                let dy = isa.splat(ways[1][j][lane]);
                for k in 0..2 {
                    let dz = isa.splat(ways[2][k][lane]);
                    let h = usize::from(hash(column ^ (z + k)) & 255);
                    let x = isa.mul(isa.load(&SPREAD.0[h + 1]), dx);
                    let y = isa.mul(isa.load(&SPREAD.0[h + 2]), dy);
                    let z = isa.mul(isa.load(&SPREAD.0[h + 3]), dz);
                    let twice = isa.add(isa.load(&SPREAD.0[h]), isa.add(isa.add(x, y), z));
                    let share = isa.splat(shares[4 * i + 2 * j + k][lane]);
                    octave = isa.add(octave, isa.mul(twice, share));
                }
            }
        }
        sum = isa.add(sum, isa.mul(octave, isa.splat(strengths[lane])));
    }
    sum
}

/// The same for octaves of which some may be far away.
#[cold]
#[inline(never)]
fn add_far_vectors(
    points: &[[f64; 4]; 3],
    strengths: &[f64; 4],
    count: usize,
    sum: [f64; 4],
) -> [f64; 4] {
    let isa = Portable;
    let mut sum = sum;
    for lane in 0..count {
        let p = [points[0][lane], points[1][lane], points[2][lane], 0.0];
        let octave = isa.mul(vector(isa, p), isa.splat(strengths[lane]));
        sum = isa.add(sum, octave);
    }
    sum
}

/// The gradient noise.
#[inline(always)]
fn perlin<I: Isa>(p: DVec3) -> f64 {
    let p = p + DVec3::splat(SHIFT);
    let (x, y, z) = (place::<I>(p.x), place::<I>(p.y), place::<I>(p.z));
    let [i, j, k] = [x.0, y.0, z.0];
    let (i, j) = ([i, i.wrapping_add(1)], [j, j.wrapping_add(1)]);
    let k = [k as usize & 2047, k.wrapping_add(1) as usize & 2047];
    let (dx, dy, dz) = (ways(x.1), ways(y.1), ways(z.1));
    let (sx, sy, sz) = (shares(x.1), shares(y.1), shares(z.1));
    let mut sum = 0.0;
    for a in 0..2 {
        for b in 0..2 {
            let row = perlin_row(i[a] as usize & 2047, j[b] as usize & 2047);
            let share = sx[a] * sy[b];
            for c in 0..2 {
                let gradient = GRADIENTS[(row + k[c]) & 2047];
                let way = DVec3::new(dx[a], dy[b], dz[c]);
                sum += share * sz[c] * gradient.dot(way);
            }
        }
    }
    sum
}
