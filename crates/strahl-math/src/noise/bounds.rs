//! What noise can be within a box: for proofs that a function has no zero there.

use super::kernel::{CELL_SHIFT, OVERFLOW, floor, whole};
use super::tables::{CORNERS, hash};
use super::{NoiseGenerator, SHIFT, perlin_gradient, smooth, unit};
use crate::DVec3;
use strahl_simd::{Isa, Simd, dispatch};

/// More than the rounding errors of noise, whose terms are of the size of 1.
const ROUNDING: f64 = 1e-12;

/// Two numbers, the lower one first.
type Range = (f64, f64);

/// Bounds of [`noise`](super::noise) over the box from `min` to `max`: exact for points, up to about three times as wide as
/// need be for small boxes, `(0, 1)` for boxes that reach over more than two cells of the lattice.
///
/// Within a cell each corner's linear function is bounded exactly, and so is the share of each side of a blend, which is
/// monotone; the three blends are then done on bounds.
pub fn noise_bounds(min: DVec3, max: DVec3, generator: NoiseGenerator) -> Range {
    dispatch!(Simd::best(), isa => within(isa, min, max, None, generator).value)
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
}

#[inline(always)]
fn within<I: Isa>(
    isa: I,
    min: DVec3,
    max: DVec3,
    way: Option<&[Range; 3]>,
    generator: NoiseGenerator,
) -> Course {
    let raw = match generator {
        NoiseGenerator::Perlin => {
            let shift = DVec3::splat(SHIFT);
            over_cells(isa, min + shift, max + shift, way, generator)
        }
        _ => over_cells(isa, min, max, way, generator),
    };
    let Some(Course { value, rate }) = raw else {
        return Course {
            value: (0.0, 1.0),
            rate: (f64::NEG_INFINITY, f64::INFINITY),
        };
    };
    let (low, high) = (
        end(value.0, -ROUNDING, generator),
        end(value.1, ROUNDING, generator),
    );
    let factor = match generator {
        NoiseGenerator::Original => 1.0,
        NoiseGenerator::RangeCorrected => 0.48985582,
        NoiseGenerator::Perlin => 0.795,
    };
    let speed: f64 = way.map_or(0.0, |way| {
        way.iter().map(|(a, b)| a.abs().max(b.abs())).sum()
    });
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

/// From the sum over the corners to the noise.
#[inline(always)]
fn end(x: f64, pad: f64, generator: NoiseGenerator) -> f64 {
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
    min: DVec3,
    max: DVec3,
    way: Option<&[Range; 3]>,
    generator: NoiseGenerator,
) -> Option<Course> {
    if min.cmple(DVec3::splat(-OVERFLOW)).any() || max.cmpge(DVec3::splat(OVERFLOW)).any() {
        return None;
    }
    let floors = |p: DVec3| DVec3::new(floor::<I>(p.x), floor::<I>(p.y), floor::<I>(p.z));
    let (first, last) = (floors(min), floors(max));
    // Also refuses NaN.
    if !((last - first).cmple(DVec3::ONE).all() && max.cmpge(min).all()) {
        return None;
    }
    let mut hull: Option<Course> = None;
    for bits in 0..8_usize {
        let step = DVec3::new(
            (bits >> 2) as f64,
            (bits >> 1 & 1) as f64,
            (bits & 1) as f64,
        );
        let cell = first + step;
        if cell.cmpgt(last).any() {
            continue;
        }
        let from = (min - cell).max(DVec3::ZERO);
        let to = (max - cell).min(DVec3::ONE);
        let course = in_cell(isa, cell, from, to, way, generator);
        hull = Some(hull.map_or(course, |hull| hull.hull(course)));
    }
    hull
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

/// Bounds over the part of one cell between `from` and `to`, both in the unit cube.
#[inline(always)]
fn in_cell<I: Isa>(
    isa: I,
    cell: DVec3,
    from: DVec3,
    to: DVec3,
    way: Option<&[Range; 3]>,
    generator: NoiseGenerator,
) -> Course {
    let numbers = if generator == NoiseGenerator::Perlin {
        [cell.x, cell.y, cell.z].map(|c| whole(c) & 2047)
    } else {
        [cell.x, cell.y, cell.z].map(whole)
    };
    let (middle, reach) = (0.5 * (from + to), 0.5 * (to - from));
    // From four corners to the middle, along x and y.
    let (x, y) = (middle.x, middle.y);
    let ways = [
        isa.load(&[x, x, x - 1.0, x - 1.0]),
        isa.load(&[y, y - 1.0, y, y - 1.0]),
    ];
    let zero = isa.splat(0.0);
    let (mut at, mut rates) = ([(zero, zero); 2], [(zero, zero); 2]);
    for z in 0..2 {
        let [value, gx, gy, gz] = corners(isa, numbers, z, generator);
        let deep = isa.splat(middle.z - z as f64);
        let middle = isa.add(value, along(isa, [gx, gy, gz], [ways[0], ways[1], deep]));
        let [rx, ry, rz] = [gx, gy, gz].map(
            #[inline(always)]
            |g| isa.abs(g),
        );
        let splat = |p: [f64; 3]| [isa.splat(p[0]), isa.splat(p[1]), isa.splat(p[2])];
        let off = along(isa, [rx, ry, rz], splat(reach.to_array()));
        at[z] = (isa.sub(middle, off), isa.add(middle, off));
        if let Some([x, y, z_way]) = way {
            let mid = |r: &Range| 0.5 * (r.0 + r.1);
            let half = |r: &Range| 0.5 * (r.1 - r.0);
            let middle = along(isa, [gx, gy, gz], splat([mid(x), mid(y), mid(z_way)]));
            let off = along(isa, [rx, ry, rz], splat([half(x), half(y), half(z_way)]));
            rates[z] = (isa.sub(middle, off), isa.add(middle, off));
        }
    }
    let shares = [0, 1, 2].map(
        #[inline(always)]
        |axis| Share::new(from[axis], to[axis], way.map(|way| way[axis])),
    );
    let Share { s0, s1, q0, q1 } = shares[2];
    let (low, high) = ends(isa, at[0], at[1], (s0, s1));
    let (low, high) = (isa.store(low), isa.store(high));
    let (mut fall, mut rise) = ([0.0; 4], [0.0; 4]);
    if way.is_some() {
        let (least, most) = ends(isa, rates[0], rates[1], (s0, s1));
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
    let column = |k: usize| Course {
        value: (low[k], high[k]),
        rate: (fall[k], rise[k]),
    };
    let asked = way.is_some();
    let lower = shares[1].blend(column(0), column(1), asked);
    let upper = shares[1].blend(column(2), column(3), asked);
    shares[0].blend(lower, upper, asked)
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
    (s0, s1): Range,
) -> (I::F64x4, I::F64x4) {
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

impl Share {
    /// Between two places of the unit interval, if the place changes at this rate.
    #[inline(always)]
    fn new(from: f64, to: f64, rate: Option<Range>) -> Self {
        let (mut q0, mut q1) = (0.0, 0.0);
        if let Some((a, b)) = rate {
            // The derivative of the share by the place rises up to 1/2 and falls from there.
            let slope = |t: f64| 6.0 * t * (1.0 - t);
            let (p, q) = (slope(from), slope(to));
            let most = if from < 0.5 && to > 0.5 {
                1.5
            } else {
                p.max(q)
            };
            let least = p.min(q);
            q0 = a * if a < 0.0 { most } else { least };
            q1 = b * if b < 0.0 { least } else { most };
        }
        Self {
            s0: smooth(from),
            s1: smooth(to),
            q0,
            q1,
        }
    }

    /// Bounds of `a + s (b - a)`: it is linear in the share `s`, so an end is extreme. `rates` says whether the derivative is asked for.
    #[inline(always)]
    fn blend(self, a: Course, b: Course, rates: bool) -> Course {
        let mix = |a: f64, b: f64, s: f64| a * (1.0 - s) + b * s;
        let ends = |a: Range, b: Range| {
            let low = mix(a.0, b.0, self.s0).min(mix(a.0, b.0, self.s1));
            let high = mix(a.1, b.1, self.s0).max(mix(a.1, b.1, self.s1));
            (low, high)
        };
        let mut rate = (0.0, 0.0);
        if rates {
            let (down, up) = (b.value.0 - a.value.1, b.value.1 - a.value.0);
            let (fall, rise) = ends(a.rate, b.rate);
            let products = [self.q0 * down, self.q0 * up, self.q1 * down, self.q1 * up];
            let [p, q, r, s] = products;
            rate = (fall + p.min(q).min(r.min(s)), rise + p.max(q).max(r.max(s)));
        }
        Course {
            value: ends(a.value, b.value),
            rate,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::noise;
    use super::*;

    struct Random(u64);

    impl Random {
        fn unit(&mut self) -> f64 {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        }

        fn cube(&mut self) -> DVec3 {
            DVec3::new(self.unit(), self.unit(), self.unit())
        }
    }

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
                    widest <= 8.0 * size + 1e-11,
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
