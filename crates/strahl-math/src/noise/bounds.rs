//! What noise can be within a box: for proofs that a function has no zero there.

use super::kernel::{CELL_SHIFT, OVERFLOW, smooth_lanes, whole};
use super::tables::{CORNERS, hash};
use super::{NoiseGenerator, SHIFT, perlin_gradient, unit};
use crate::DVec3;
use strahl_simd::{Isa, Simd, dispatch};

/// More than the rounding errors of noise, whose terms are of the size of 1.
const ROUNDING: f64 = 1e-12;

/// More than the rounding errors of the noise of a generator. Gradient noise rounds coordinates to multiples of 2⁻²⁹ and is no steeper than 5 in
/// all.
#[inline(always)]
fn rounding(generator: NoiseGenerator) -> f64 {
    match generator {
        NoiseGenerator::Perlin => 1e-8,
        _ => ROUNDING,
    }
}

/// Two numbers, the lower one first.
pub(super) type Range = (f64, f64);

/// Bounds of [`noise`](super::noise) over the box from `min` to `max`: exact but for rounding for points, up to about three times as wide as
/// need be for small boxes, `(0, 1)` for boxes that reach over more than two cells of the lattice.
///
/// Within a cell each corner's linear function is bounded exactly, and so is the share of each side of a blend, which is
/// monotone; the three blends are then done on bounds.
pub fn noise_bounds(min: DVec3, max: DVec3, generator: NoiseGenerator) -> Range {
    dispatch!(Simd::best(), isa => within(isa, min, max, None, generator).value)
}

/// Stores [`noise_bounds`] over boxes of which the first is `area` (from its least to its largest corner) and each is the one before times
/// `lacunarity`, rounded outwards; tells how many boxes there are until all others reach over more than two cells, the bounds of which
/// are `(0, 1)` and not stored. `area` becomes the box after the last one that is stored.
pub fn store_octave_bounds(
    area: &mut [DVec3; 2],
    lacunarity: f64,
    generator: NoiseGenerator,
    ranges: &mut [Range],
) -> usize {
    dispatch!(Simd::best(), isa => octaves_within(isa, area, lacunarity, generator, ranges))
}

#[inline(always)]
pub(super) fn octaves_within<I: Isa>(
    isa: I,
    area: &mut [DVec3; 2],
    lacunarity: f64,
    generator: NoiseGenerator,
    ranges: &mut [Range],
) -> usize {
    let by = isa.splat(lacunarity);
    let [min, max] = *area;
    let mut low = isa.load(&[min.x, min.y, min.z, 0.0]);
    let mut high = isa.load(&[max.x, max.y, max.z, 0.0]);
    let shift = isa.splat(match generator {
        NoiseGenerator::Perlin => SHIFT,
        _ => 0.0,
    });
    let mut count = ranges.len();
    for (octave, range) in ranges.iter_mut().enumerate() {
        let (min, max) = (isa.add(low, shift), isa.add(high, shift));
        let found = over_cells(isa, min, max, None, generator);
        *range = scaled(found, 0.0, generator).value;
        if found.is_none() {
            // Boxes that are as wide and do not shrink; a little more, for rounding.
            let is_wide = isa.lt(isa.splat(2.1), isa.sub(high, low)) & 0b111 != 0;
            if is_wide && lacunarity.abs() >= 1.0 {
                count = octave;
                break;
            }
        }
        let (a, b) = (isa.mul(low, by), isa.mul(high, by));
        low = outwards(isa, isa.min(a, b), -NEXT);
        high = outwards(isa, isa.max(a, b), NEXT);
    }
    let ([x, y, z, _], [a, b, c, _]) = (isa.store(low), isa.store(high));
    *area = [DVec3::new(x, y, z), DVec3::new(a, b, c)];
    count
}

/// This part of a number, added to it, gives the next one: a bit more than half the place of its last bit.
const NEXT: f64 = 0.5 * f64::EPSILON * (1.0 + f64::EPSILON);

/// The next number (those below the smallest normal one stay, which noise cannot tell).
#[inline(always)]
fn outwards<I: Isa>(isa: I, x: I::F64x4, next: f64) -> I::F64x4 {
    isa.add(x, isa.mul(isa.abs(x), isa.splat(next)))
}

/// [`noise_bounds`], and bounds of the derivative of noise along a line in the box, on which each coordinate changes at a rate within bounds
/// (`way`, finite); infinite where the box reaches over more than two cells.
///
/// The derivatives are those of the blends, by the product rule on bounds.
pub fn noise_rate(
    min: DVec3,
    max: DVec3,
    way: &[Range; 3],
    generator: NoiseGenerator,
) -> (Range, Range) {
    let found = dispatch!(Simd::best(), isa => within(isa, min, max, Some(way), generator));
    (found.value, found.rate)
}

/// Bounds of a function and of its derivative along a line; the latter are zero if they are not asked for.
#[derive(Clone, Copy)]
struct Course {
    value: Range,
    rate: Range,
}

impl Course {
    fn hull(self, other: Self) -> Self {
        let hull = |a: Range, b: Range| (a.0.min(b.0), a.1.max(b.1));
        Self {
            value: hull(self.value, other.value),
            rate: hull(self.rate, other.rate),
        }
    }

    /// Bounds also of places so near to the box that noise changes by no more than `pad` on the way, and its derivatives by four times as much.
    #[inline(always)]
    fn widened(self, pad: f64, way: Option<&[Range; 3]>) -> Self {
        let off = 4.0 * pad * way.map_or(0.0, speed);
        Self {
            value: (self.value.0 - pad, self.value.1 + pad),
            rate: (self.rate.0 - off, self.rate.1 + off),
        }
    }
}

/// How fast coordinates change at most, in all.
#[inline(always)]
fn speed(way: &[Range; 3]) -> f64 {
    way.iter().map(|(a, b)| a.abs().max(b.abs())).sum()
}

#[inline(always)]
fn within<I: Isa>(
    isa: I,
    min: DVec3,
    max: DVec3,
    way: Option<&[Range; 3]>,
    generator: NoiseGenerator,
) -> Course {
    let shift = match generator {
        NoiseGenerator::Perlin => DVec3::splat(SHIFT),
        _ => DVec3::ZERO,
    };
    let (min, max) = (min + shift, max + shift);
    let min = isa.load(&[min.x, min.y, min.z, 0.0]);
    let max = isa.load(&[max.x, max.y, max.z, 0.0]);
    let speed = way.map_or(0.0, speed);
    scaled(over_cells(isa, min, max, way, generator), speed, generator)
}

/// Bounds of noise by those of the sum over the corners, if they are known. `speed` is how fast coordinates change at most, in all.
#[inline(always)]
fn scaled(raw: Option<Course>, speed: f64, generator: NoiseGenerator) -> Course {
    let Some(Course { value, rate }) = raw else {
        return Course {
            value: (0.0, 1.0),
            rate: (f64::NEG_INFINITY, f64::INFINITY),
        };
    };
    let pad = rounding(generator);
    let (low, high) = (end(value.0, -pad, generator), end(value.1, pad, generator));
    let factor = factor(generator);
    let pad = ROUNDING * 16.0 * speed;
    let mut rate = (rate.0 * factor - pad, rate.1 * factor + pad);
    // Where noise is cut off it does not change.
    if low <= 0.0 || high >= 1.0 {
        rate = (rate.0.min(0.0), rate.1.max(0.0));
    }
    Course {
        value: (low, high),
        rate,
    }
}

/// How fast noise changes with the sum over the corners.
#[inline(always)]
pub(super) fn factor(generator: NoiseGenerator) -> f64 {
    match generator {
        NoiseGenerator::Original => 1.0,
        NoiseGenerator::RangeCorrected => 0.48985582,
        NoiseGenerator::Perlin => 0.795,
    }
}

/// From the sum over the corners to the noise.
#[inline(always)]
pub(super) fn end(x: f64, pad: f64, generator: NoiseGenerator) -> f64 {
    unit(match generator {
        NoiseGenerator::Original => x + 0.5 + pad,
        NoiseGenerator::RangeCorrected => (x + 1.05242) * 0.48985582 + pad,
        NoiseGenerator::Perlin => 0.4925 + 0.795 * x + pad,
    })
}

/// The hull of the bounds in all cells that the box meets; `None` if they are too many or beyond the range of 32-bit integers.
#[inline(always)]
fn over_cells<I: Isa>(
    isa: I,
    min: I::F64x4,
    max: I::F64x4,
    way: Option<&[Range; 3]>,
    generator: NoiseGenerator,
) -> Option<Course> {
    let is_near = isa.lt(isa.splat(-OVERFLOW), min) & isa.lt(max, isa.splat(OVERFLOW));
    // Also refuses NaN.
    if is_near & isa.le(min, max) != 0b1111 {
        return None;
    }
    let (zero, one) = (isa.splat(0.0), isa.splat(1.0));
    let (mut min, mut max, mut is_cut) = (min, max, false);
    let (mut first, mut last) = (isa.floor(min), isa.floor(max));
    if isa.lt(first, last) != 0 && has_slivers(isa, min, max, first, last) {
        (min, max, is_cut) = without_slivers(isa, min, max);
        first = isa.floor(min);
        // A box that ends at a plane reaches no further.
        let ceil = isa.sub(zero, isa.floor(isa.sub(zero, max)));
        last = isa.max(first, isa.sub(ceil, one));
    }
    if isa.lt(one, isa.sub(last, first)) != 0 {
        return None;
    }
    // The axes along which the box reaches into a second cell, a bit for each; all sets of them are a cell each.
    let axes = isa.lt(first, last);
    let (mut steps, mut hull) = (0_u32, None::<Course>);
    loop {
        let (x, y, z) = (steps & 1, steps >> 1 & 1, steps >> 2);
        let step = isa.load(&[f64::from(x), f64::from(y), f64::from(z), 0.0]);
        let cell = isa.add(first, step);
        let from = isa.max(isa.sub(min, cell), zero);
        let to = isa.min(isa.sub(max, cell), one);
        let course = in_cell(isa, cell, from, to, way, generator);
        let all = match hull {
            None => course,
            Some(others) => others.hull(course),
        };
        steps = steps.wrapping_sub(axes) & axes;
        if steps == 0 {
            return Some(if is_cut {
                all.widened(16.0 * SLIVER, way)
            } else {
                all
            });
        }
        hull = Some(all);
    }
}

/// Boxes that reach no further into a cell, in part no more than a thousandth of their width, are bounded without that part.
const SLIVER: f64 = 1e-9;

/// Whether a box may reach so little into cells at one of its ends. What is computed for one that does takes more time.
#[inline(always)]
fn has_slivers<I: Isa>(
    isa: I,
    min: I::F64x4,
    max: I::F64x4,
    first: I::F64x4,
    last: I::F64x4,
) -> bool {
    let limit = isa.splat(SLIVER);
    let near_upper = isa.le(isa.sub(isa.add(first, isa.splat(1.0)), min), limit);
    (near_upper | isa.le(isa.sub(max, last), limit)) & 0b111 != 0
}

/// The box without the slivers that lie in further cells, as one has that lies along the planes of the lattice and is widened for rounding; and
/// whether there are any. Noise and its derivatives are continuous, so they hardly change there.
#[inline(always)]
fn without_slivers<I: Isa>(isa: I, min: I::F64x4, max: I::F64x4) -> (I::F64x4, I::F64x4, bool) {
    let zero = isa.splat(0.0);
    let width = isa.sub(max, min);
    let limit = isa.min(isa.splat(SLIVER), isa.mul(isa.splat(1e-3), width));
    let above = isa.sub(zero, isa.floor(isa.sub(zero, min)));
    let below = isa.floor(max);
    let (near, far) = (isa.sub(above, min), isa.sub(max, below));
    let from = isa.choose_le(near, limit, above, min);
    let to = isa.choose_le(far, limit, below, max);
    let cut = isa.lt(min, from) | isa.lt(to, max);
    (from, to, cut != 0)
}

/// The values and gradients of the four lower (0) or upper (1) corners of a cell along z; corner `2 i + j` is the lower or the upper one along x
/// and along y.
#[inline(always)]
fn corners<I: Isa>(isa: I, cell: [usize; 3], z: usize, generator: NoiseGenerator) -> [I::F64x4; 4] {
    let mut all = [isa.splat(0.0); 4];
    if generator == NoiseGenerator::Perlin {
        for (n, corner) in all.iter_mut().enumerate() {
            let g = perlin_gradient(cell, [n >> 1, n & 1, z]);
            *corner = isa.load(&[0.0, g.x, g.y, g.z]);
        }
    } else {
        let by = CELL_SHIFT as usize;
        for x in 0..2 {
            let row = usize::from(hash((cell[0] + by + x) & 4095));
            for y in 0..2 {
                let column = usize::from(hash(row ^ (cell[1] + by + y) & 4095));
                let h = usize::from(hash(column ^ (cell[2] + by + z) & 4095) & 255);
                all[2 * x + y] = isa.load(&CORNERS.0[h]);
            }
        }
    }
    isa.transpose(all)
}

/// Bounds over the part of one cell between `from` and `to`, both in the unit cube. The last lanes mean nothing.
#[inline(always)]
fn in_cell<I: Isa>(
    isa: I,
    cell: I::F64x4,
    from: I::F64x4,
    to: I::F64x4,
    way: Option<&[Range; 3]>,
    generator: NoiseGenerator,
) -> Course {
    let [x, y, z, _] = isa.store(cell);
    let mut numbers = [whole(x), whole(y), whole(z)];
    if generator == NoiseGenerator::Perlin {
        for number in &mut numbers {
            *number &= 2047;
        }
    }
    let half = isa.splat(0.5);
    let middle = isa.store(isa.mul(half, isa.add(from, to)));
    let reach = isa.store(isa.mul(half, isa.sub(to, from)));
    let reach = [
        isa.splat(reach[0]),
        isa.splat(reach[1]),
        isa.splat(reach[2]),
    ];
    // From four corners to the middle, along x and y.
    let (x, y) = (middle[0], middle[1]);
    let ways = [
        isa.load(&[x, x, x - 1.0, x - 1.0]),
        isa.load(&[y, y - 1.0, y, y - 1.0]),
    ];
    let zero = isa.splat(0.0);
    let (mut at, mut rates) = ([(zero, zero); 2], [(zero, zero); 2]);
    for z in 0..2 {
        let [value, gx, gy, gz] = corners(isa, numbers, z, generator);
        let deep = isa.splat(middle[2] - z as f64);
        let middle = isa.add(value, along(isa, [gx, gy, gz], [ways[0], ways[1], deep]));
        let sizes = [isa.abs(gx), isa.abs(gy), isa.abs(gz)];
        let off = along(isa, sizes, reach);
        at[z] = (isa.sub(middle, off), isa.add(middle, off));
        if let Some([x, y, z_way]) = way {
            let middle = along(
                isa,
                [gx, gy, gz],
                [
                    isa.splat(0.5 * (x.0 + x.1)),
                    isa.splat(0.5 * (y.0 + y.1)),
                    isa.splat(0.5 * (z_way.0 + z_way.1)),
                ],
            );
            let off = along(
                isa,
                sizes,
                [
                    isa.splat(0.5 * (x.1 - x.0)),
                    isa.splat(0.5 * (y.1 - y.0)),
                    isa.splat(0.5 * (z_way.1 - z_way.0)),
                ],
            );
            rates[z] = (isa.sub(middle, off), isa.add(middle, off));
        }
    }
    let s0 = isa.store(smooth_lanes(isa, from));
    let s1 = isa.store(smooth_lanes(isa, to));
    let (q0, q1) = match way {
        Some(way) => share_rates(isa, from, to, way),
        None => ([0.0; 4], [0.0; 4]),
    };
    let share = |axis: usize| Share {
        s0: s0[axis],
        s1: s1[axis],
        q0: q0[axis],
        q1: q1[axis],
    };
    let asked = way.is_some();
    let (low, high) = ends(isa, at[0], at[1], share(2));
    let (low, high) = (isa.store(low), isa.store(high));
    let (mut fall, mut rise) = ([0.0; 4], [0.0; 4]);
    if asked {
        let Share { q0, q1, .. } = share(2);
        let (least, most) = ends(isa, rates[0], rates[1], share(2));
        let down = isa.sub(at[1].0, at[0].1);
        let up = isa.sub(at[1].1, at[0].0);
        let (q0, q1) = (isa.splat(q0), isa.splat(q1));
        let (a, b) = (isa.mul(q0, down), isa.mul(q0, up));
        let (c, d) = (isa.mul(q1, down), isa.mul(q1, up));
        let less = isa.min(isa.min(a, b), isa.min(c, d));
        let more = isa.max(isa.max(a, b), isa.max(c, d));
        fall = isa.store(isa.add(least, less));
        rise = isa.store(isa.add(most, more));
    }
    let [lower, upper] = blend_pairs(isa, [low, high, fall, rise], share(1), asked);
    blend(isa, lower, upper, share(0), asked)
}

/// The derivative along a line of the share of the upper side of a blend, axis by axis: between two numbers each.
#[inline(always)]
fn share_rates<I: Isa>(
    isa: I,
    from: I::F64x4,
    to: I::F64x4,
    way: &[Range; 3],
) -> ([f64; 4], [f64; 4]) {
    let (half, one, six) = (isa.splat(0.5), isa.splat(1.0), isa.splat(6.0));
    // The derivative of the share by the place rises up to 1/2 and falls from there.
    let p = isa.mul(isa.mul(six, from), isa.sub(one, from));
    let q = isa.mul(isa.mul(six, to), isa.sub(one, to));
    let (least, most) = (isa.min(p, q), isa.max(p, q));
    let top = isa.splat(1.5);
    let most = isa.choose_le(half, from, most, isa.choose_le(to, half, most, top));
    let zero = isa.splat(0.0);
    let a = isa.load(&[way[0].0, way[1].0, way[2].0, 0.0]);
    let b = isa.load(&[way[0].1, way[1].1, way[2].1, 0.0]);
    let q0 = isa.mul(a, isa.choose_le(zero, a, least, most));
    let q1 = isa.mul(b, isa.choose_le(zero, b, most, least));
    (isa.store(q0), isa.store(q1))
}

/// The sum of three products.
#[inline(always)]
fn along<I: Isa>(isa: I, g: [I::F64x4; 3], way: [I::F64x4; 3]) -> I::F64x4 {
    let xy = isa.add(isa.mul(g[0], way[0]), isa.mul(g[1], way[1]));
    isa.add(xy, isa.mul(g[2], way[2]))
}

#[inline(always)]
fn mix<I: Isa>(isa: I, a: I::F64x4, b: I::F64x4, s: f64) -> I::F64x4 {
    isa.add(isa.mul(a, isa.splat(1.0 - s)), isa.mul(b, isa.splat(s)))
}

/// The smallest and the largest mix of two ranges for a share between two numbers: it is linear in the share, so an end is extreme.
#[inline(always)]
fn ends<I: Isa>(
    isa: I,
    a: (I::F64x4, I::F64x4),
    b: (I::F64x4, I::F64x4),
    share: Share,
) -> (I::F64x4, I::F64x4) {
    let (s0, s1) = (share.s0, share.s1);
    let low = isa.min(mix(isa, a.0, b.0, s0), mix(isa, a.0, b.0, s1));
    let high = isa.max(mix(isa, a.1, b.1, s0), mix(isa, a.1, b.1, s1));
    (low, high)
}

/// The share of the upper side of a blend along one axis, and its derivative along a line: between two numbers each.
#[derive(Clone, Copy)]
struct Share {
    s0: f64,
    s1: f64,
    q0: f64,
    q1: f64,
}

#[inline(always)]
fn less(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline(always)]
fn more(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The blends of columns 0 and 1 and of columns 2 and 3 of least and largest values and rates. `asked` says whether the latter are asked
/// for.
#[inline(always)]
fn blend_pairs<I: Isa>(
    isa: I,
    [low, high, fall, rise]: [[f64; 4]; 4],
    share: Share,
    asked: bool,
) -> [Course; 2] {
    let (least, most) = ends_of_pairs(isa, low, high, share);
    let course = |k: usize| Course {
        value: (least[k], most[k]),
        rate: (0.0, 0.0),
    };
    let mut courses = [course(0), course(1)];
    if asked {
        let (least, most) = ends_of_pairs(isa, fall, rise, share);
        let from = isa.load(&[high[0], high[2], low[0], low[2]]);
        let to = isa.load(&[low[1], low[3], high[1], high[3]]);
        let change = isa.sub(to, from);
        let p = isa.mul(isa.splat(share.q0), change);
        let q = isa.mul(isa.splat(share.q1), change);
        let (down, up) = (isa.store(isa.min(p, q)), isa.store(isa.max(p, q)));
        for k in 0..2 {
            courses[k].rate = (
                least[k] + less(down[k], down[k + 2]),
                most[k] + more(up[k], up[k + 2]),
            );
        }
    }
    courses
}

/// [`ends`] for columns 0 and 1 and for columns 2 and 3.
#[inline(always)]
fn ends_of_pairs<I: Isa>(
    isa: I,
    low: [f64; 4],
    high: [f64; 4],
    share: Share,
) -> ([f64; 2], [f64; 2]) {
    // Lanes 0 and 1 have the least numbers of both blends, lanes 2 and 3 the largest ones.
    let a = isa.load(&[low[0], low[2], high[0], high[2]]);
    let b = isa.load(&[low[1], low[3], high[1], high[3]]);
    let (p, q) = (mix(isa, a, b, share.s0), mix(isa, a, b, share.s1));
    let (least, most) = (isa.store(isa.min(p, q)), isa.store(isa.max(p, q)));
    ([least[0], least[1]], [most[2], most[3]])
}

/// [`ends`] for one pair, where the shares are in lanes 0 and 1 and again in lanes 2 and 3, and `rest` is what is left of them.
#[inline(always)]
fn ends_of_one<I: Isa>(isa: I, a: Range, b: Range, s: I::F64x4, rest: I::F64x4) -> Range {
    let a = isa.load(&[a.0, a.0, a.1, a.1]);
    let b = isa.load(&[b.0, b.0, b.1, b.1]);
    let mixes = isa.store(isa.add(isa.mul(a, rest), isa.mul(b, s)));
    (less(mixes[0], mixes[1]), more(mixes[2], mixes[3]))
}

/// Bounds of `a + s (b - a)`: it is linear in the share `s`, so an end is extreme. `asked` says whether the derivative is asked for.
#[inline(always)]
fn blend<I: Isa>(isa: I, a: Course, b: Course, share: Share, asked: bool) -> Course {
    let Share { s0, s1, q0, q1 } = share;
    let s = isa.load(&[s0, s1, s0, s1]);
    let rest = isa.sub(isa.splat(1.0), s);
    let mut rate = (0.0, 0.0);
    if asked {
        let (down, up) = (b.value.0 - a.value.1, b.value.1 - a.value.0);
        let (fall, rise) = ends_of_one(isa, a.rate, b.rate, s, rest);
        let [p, q] = [q0 * down, q0 * up];
        let [r, s] = [q1 * down, q1 * up];
        rate = (
            fall + less(less(p, q), less(r, s)),
            rise + more(more(p, q), more(r, s)),
        );
    }
    Course {
        value: ends_of_one(isa, a.value, b.value, s, rest),
        rate,
    }
}

#[cfg(test)]
mod tests {
    use super::super::{noise, random::Random};
    use super::*;

    #[test]
    fn bounds_hold_and_close_in_on_the_value() {
        use NoiseGenerator::{Original, Perlin, RangeCorrected};
        let mut random = Random(1);
        for generator in [Original, RangeCorrected, Perlin] {
            for size in [0.9, 0.3, 0.05, 1e-3, 0.0] {
                let mut widest: f64 = 0.0;
                for _ in 0..300 {
                    let min = (random.cube() - DVec3::splat(0.5)) * 60.0;
                    let max = min + random.cube() * size;
                    let (low, high) = noise_bounds(min, max, generator);
                    for simd in Simd::available() {
                        let found =
                            dispatch!(simd, isa => within(isa, min, max, None, generator)).value;
                        assert_eq!(found, (low, high), "{simd:?}");
                    }
                    widest = widest.max(high - low);
                    for _ in 0..20 {
                        let value = noise(min + (max - min) * random.cube(), generator);
                        assert!(
                            low <= value && value <= high,
                            "{value} {low} {high} {min} {max}"
                        );
                    }
                }
                assert!(
                    widest <= 8.0 * size + 10.0 * rounding(generator),
                    "{generator:?} {size}: {widest}"
                );
            }
        }
    }

    #[test]
    fn rates_hold_and_close_in_on_the_derivative() {
        use NoiseGenerator::{Original, Perlin, RangeCorrected};
        let mut random = Random(2);
        for generator in [Original, RangeCorrected, Perlin] {
            for size in [0.9, 0.3, 0.05, 1e-3] {
                let mut widest: f64 = 0.0;
                for case in 0..300 {
                    let start = (random.cube() - DVec3::splat(0.5)) * 60.0;
                    let way = random.cube() * 2.0 - DVec3::ONE;
                    let last = start + way * size;
                    let (min, max) = (start.min(last), start.max(last));
                    // Exact rates, or bounds of them.
                    let pad = if case % 2 == 0 { 0.0 } else { 0.1 };
                    let rates = way.to_array().map(|w| (w - pad, w + pad));
                    let found = noise_rate(min, max, &rates, generator);
                    assert_eq!(found.0, noise_bounds(min, max, generator));
                    for simd in Simd::available() {
                        let same =
                            dispatch!(simd, isa => within(isa, min, max, Some(&rates), generator));
                        assert_eq!((same.value, same.rate), found, "{simd:?}");
                    }
                    let (fall, rise) = found.1;
                    // Noise that is cut off has a kink there.
                    if pad == 0.0 && found.0.0 > 0.0 && found.0.1 < 1.0 {
                        widest = widest.max(rise - fall);
                    }
                    for _ in 0..20 {
                        let (a, b) = (random.unit() * size, random.unit() * size);
                        let at = |s: f64| noise(start + way * s, generator);
                        let (change, least) = (at(b) - at(a), (b - a) * fall);
                        let most = (b - a) * rise;
                        let room = 1e-9;
                        assert!(
                            least.min(most) - room <= change && change <= least.max(most) + room,
                            "{generator:?} {change} {least} {most} {start} {way}"
                        );
                    }
                }
                assert!(widest <= 60.0 * size, "{generator:?} {size}: {widest}");
            }
        }
        let (min, max) = (DVec3::ZERO, DVec3::splat(2.5));
        let all = (f64::NEG_INFINITY, f64::INFINITY);
        let found = noise_rate(min, max, &[(1.0, 1.0); 3], Perlin);
        assert_eq!(found, ((0.0, 1.0), all));
    }

    #[test]
    fn boxes_along_planes_of_the_lattice_may_reach_a_little_further() {
        let mut random = Random(3);
        for generator in [NoiseGenerator::Original, NoiseGenerator::RangeCorrected] {
            for case in 0..400 {
                let min = ((random.cube() - DVec3::splat(0.5)) * 40.0).round() * 0.25;
                let max = min + DVec3::splat(0.25);
                let pad = [1e-13, 9e-10, 1e-9, 1e-7][case % 4];
                let (from, to) = (min - DVec3::splat(pad), max + DVec3::splat(pad));
                let way = random.cube() * 2.0 - DVec3::ONE;
                let rates = way.to_array().map(|w| (w, w));
                let (inner, _) = noise_rate(min, max, &rates, generator);
                let (outer, (fall, rise)) = noise_rate(from, to, &rates, generator);
                assert!(outer.0 <= inner.0 && outer.1 >= inner.1);
                if pad < 1e-9 {
                    assert!(outer.1 - outer.0 <= inner.1 - inner.0 + 5e-8);
                }
                for _ in 0..20 {
                    let at = |x: f64| {
                        // At the very ends every other time.
                        if x < 0.25 {
                            0.0
                        } else {
                            (x - 0.25).min(0.5) * 2.0
                        }
                    };
                    let t = random.cube().to_array().map(at);
                    let p = from + (to - from) * DVec3::from_array(t);
                    let value = noise(p, generator);
                    assert!(outer.0 <= value && value <= outer.1, "{value} {outer:?}");
                    let step = 1e-5;
                    let slope = (noise(p + way * step, generator) - value) / step;
                    let room = 1e-3;
                    assert!(fall - room <= slope && slope <= rise + room, "{slope}");
                }
            }
        }
    }

    #[test]
    fn large_and_strange_boxes_have_the_full_range() {
        let all = (0.0, 1.0);
        for (min, max) in [
            (0.0, 3.5),
            (f64::NAN, 1.0),
            (0.0, f64::INFINITY),
            (1.0, 0.0),
        ] {
            let (min, max) = (DVec3::splat(min), DVec3::splat(max));
            assert_eq!(noise_bounds(min, max, NoiseGenerator::Perlin), all);
            assert_eq!(noise_bounds(min, max, NoiseGenerator::Original), all);
        }
    }
}
