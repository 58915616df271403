//! Noise at a point, for the vectors of one level.

use super::tables::{CORNERS, GRADIENTS, SPREAD, hash};
use super::{NoiseGenerator, SHIFT, perlin_row, smooth, unit};
use crate::DVec3;
use strahl_simd::{Isa, Level};

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

/// The numbers of a cell and the next one in the lattice of the value-gradient noise.
#[inline(always)]
fn neighbours(cell: u32) -> [usize; 2] {
    let cell = cell.wrapping_add(CELL_SHIFT);
    [cell as usize & 4095, cell.wrapping_add(1) as usize & 4095]
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

/// The eight corners of a cell of the lattice around a point. Corner `4 i + 2 j + k` is the lower (0) or the upper (1) one along
/// each axis.
struct Corners {
    /// From the lower and the upper corners to the point, along each axis.
    ways: [[f64; 2]; 3],
    /// Their weights along each axis; the products sum to 1.
    shares: [[f64; 2]; 3],
    /// Their numbers in the table of values and gradients.
    numbers: [usize; 8],
}

impl Corners {
    #[inline(always)]
    fn around<I: Isa>(p: DVec3) -> Self {
        let (x, y, z) = (place::<I>(p.x), place::<I>(p.y), place::<I>(p.z));
        let [i, j, k] = [neighbours(x.0), neighbours(y.0), neighbours(z.0)];
        let mut numbers = [0; 8];
        for a in 0..2 {
            let row = usize::from(hash(i[a]));
            for b in 0..2 {
                let column = usize::from(hash(row ^ j[b]));
                for c in 0..2 {
                    numbers[4 * a + 2 * b + c] = usize::from(hash(column ^ k[c]) & 255);
                }
            }
        }
        Self {
            ways: [ways(x.1), ways(y.1), ways(z.1)],
            shares: [shares(x.1), shares(y.1), shares(z.1)],
            numbers,
        }
    }
}

/// [`noise`](super::noise).
#[inline(always)]
pub(super) fn noise<I: Isa>(isa: I, p: DVec3, generator: NoiseGenerator) -> f64 {
    match generator {
        NoiseGenerator::Original => unit(scalar(isa, p) + 0.5),
        NoiseGenerator::RangeCorrected => unit((scalar(isa, p) + 1.05242) * 0.48985582),
        NoiseGenerator::Perlin => unit(0.4925 + 0.795 * perlin::<I>(p)),
    }
}

/// The scalar noise, with a mean near zero: the sum over the corners, in their order, of weight times `v/2 + g · way`.
#[inline(always)]
fn scalar<I: Isa>(isa: I, p: DVec3) -> f64 {
    let c = Corners::around::<I>(p);
    let [[y0, y1], [z0, z1]] = [c.ways[1], c.ways[2]];
    let (dy, dz) = (isa.load(&[y0, y0, y1, y1]), isa.load(&[z0, z1, z0, z1]));
    let [[t0, t1], [u0, u1]] = [c.shares[1], c.shares[2]];
    let (t, u) = (isa.load(&[t0, t0, t1, t1]), isa.load(&[u0, u1, u0, u1]));
    let mut sum = 0.0;
    for i in 0..2 {
        // Four corners at once.
        let n = &c.numbers[4 * i..];
        let [value, x, y, z] = isa.transpose([
            isa.load(&CORNERS[n[0] & 255]),
            isa.load(&CORNERS[n[1] & 255]),
            isa.load(&CORNERS[n[2] & 255]),
            isa.load(&CORNERS[n[3] & 255]),
        ]);
        let x = isa.mul(x, isa.splat(c.ways[0][i]));
        let (y, z) = (isa.mul(y, dy), isa.mul(z, dz));
        let linear = isa.add(value, isa.add(isa.add(x, y), z));
        let share = isa.mul(isa.mul(isa.splat(c.shares[0][i]), t), u);
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
) -> [f64; 4] {
    let limit = isa.splat(OVERFLOW);
    let mut far = generator == NoiseGenerator::Perlin;
    for coordinates in points {
        far |= isa.lt(isa.abs(coordinates), limit) != 0b1111;
    }
    if far {
        let [x, y, z] = points;
        let points = [isa.store(x), isa.store(y), isa.store(z)];
        return one_by_one(isa, &points, generator);
    }
    let sum = scalar_of_four(isa, points);
    let value = match generator {
        NoiseGenerator::Original => isa.add(sum, isa.splat(0.5)),
        _ => {
            let shifted = isa.add(sum, isa.splat(1.05242));
            isa.mul(shifted, isa.splat(0.48985582))
        }
    };
    isa.store(isa.min(isa.max(value, isa.splat(0.0)), isa.splat(1.0)))
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
    let round = isa.splat(3.0 * LARGE);
    let mut cells = [[0.0; 4]; 3];
    let mut ways = [[one; 2]; 3];
    let mut shares = [[one; 2]; 3];
    for axis in 0..3 {
        let x = points[axis];
        // As in `floor` and `place`.
        let nearest = isa.sub(isa.add(x, round), round);
        let floor = isa.sub(nearest, isa.choose_le(nearest, x, zero, one));
        cells[axis] = isa.store(isa.add(floor, round));
        let t = isa.sub(x, floor);
        ways[axis] = [t, isa.sub(t, one)];
        let slope = isa.sub(isa.splat(3.0), isa.mul(isa.splat(2.0), t));
        let upper = isa.mul(isa.mul(t, t), slope);
        shares[axis] = [isa.sub(one, upper), upper];
    }
    let mut numbers = [[0u8; 8]; 4];
    for lane in 0..4 {
        let [i, j, k] = [
            neighbours(cells[0][lane].to_bits() as u32),
            neighbours(cells[1][lane].to_bits() as u32),
            neighbours(cells[2][lane].to_bits() as u32),
        ];
        for a in 0..2 {
            let row = usize::from(hash(i[a]));
            for b in 0..2 {
                let column = usize::from(hash(row ^ j[b]));
                for c in 0..2 {
                    numbers[lane][4 * a + 2 * b + c] = hash(column ^ k[c]) as u8;
                }
            }
        }
    }
    let mut sum = zero;
    for i in 0..2 {
        for j in 0..2 {
            let share = isa.mul(shares[0][i], shares[1][j]);
            for k in 0..2 {
                let n = 4 * i + 2 * j + k;
                let [value, x, y, z] = isa.transpose([
                    isa.load(&CORNERS[usize::from(numbers[0][n])]),
                    isa.load(&CORNERS[usize::from(numbers[1][n])]),
                    isa.load(&CORNERS[usize::from(numbers[2][n])]),
                    isa.load(&CORNERS[usize::from(numbers[3][n])]),
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

/// The vector noise.
#[inline(always)]
pub(super) fn vector<I: Isa>(isa: I, p: DVec3) -> DVec3 {
    let c = Corners::around::<I>(p);
    let mut sum = isa.splat(0.0);
    let half = isa.splat(0.5);
    for i in 0..2 {
        for j in 0..2 {
            let share = c.shares[0][i] * c.shares[1][j];
            for k in 0..2 {
                let h = c.numbers[4 * i + 2 * j + k] & 255;
                let x = isa.mul(isa.load(&SPREAD[h + 1]), isa.splat(c.ways[0][i]));
                let y = isa.mul(isa.load(&SPREAD[h + 2]), isa.splat(c.ways[1][j]));
                let z = isa.mul(isa.load(&SPREAD[h + 3]), isa.splat(c.ways[2][k]));
                let value = isa.mul(half, isa.load(&SPREAD[h]));
                let linear = isa.add(value, isa.add(isa.add(x, y), z));
                sum = isa.add(sum, isa.mul(linear, isa.splat(share * c.shares[2][k])));
            }
        }
    }
    let [x, y, z, _] = isa.store(sum);
    DVec3::new(x, y, z)
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
