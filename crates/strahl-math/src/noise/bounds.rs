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
    dispatch!(Simd::best(), isa => within(isa, min, max, generator))
}

#[inline(always)]
fn within<I: Isa>(isa: I, min: DVec3, max: DVec3, generator: NoiseGenerator) -> Range {
    let raw = match generator {
        NoiseGenerator::Perlin => {
            let shift = DVec3::splat(SHIFT);
            over_cells(isa, min + shift, max + shift, generator)
        }
        _ => over_cells(isa, min, max, generator),
    };
    let Some((low, high)) = raw else {
        return (0.0, 1.0);
    };
    (
        end(low, -ROUNDING, generator),
        end(high, ROUNDING, generator),
    )
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
fn over_cells<I: Isa>(isa: I, min: DVec3, max: DVec3, generator: NoiseGenerator) -> Option<Range> {
    if min.cmple(DVec3::splat(-OVERFLOW)).any() || max.cmpge(DVec3::splat(OVERFLOW)).any() {
        return None;
    }
    let floors = |p: DVec3| DVec3::new(floor::<I>(p.x), floor::<I>(p.y), floor::<I>(p.z));
    let (first, last) = (floors(min), floors(max));
    // Also refuses NaN.
    if !((last - first).cmple(DVec3::ONE).all() && max.cmpge(min).all()) {
        return None;
    }
    let mut hull: Option<Range> = None;
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
        let (low, high) = in_cell(isa, cell, from, to, generator);
        hull = Some(match hull {
            None => (low, high),
            Some((a, b)) => (a.min(low), b.max(high)),
        });
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
                all[2 * x + y] = isa.load(&CORNERS[h]);
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
    generator: NoiseGenerator,
) -> Range {
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
    let mut at = [(ways[0], ways[0]); 2];
    for (z, at) in at.iter_mut().enumerate() {
        let [value, gx, gy, gz] = corners(isa, numbers, z, generator);
        let way = isa.splat(middle.z - z as f64);
        let middle = isa.add(
            isa.add(isa.mul(gx, ways[0]), isa.mul(gy, ways[1])),
            isa.mul(gz, way),
        );
        let middle = isa.add(value, middle);
        let reach = isa.add(
            isa.add(
                isa.mul(isa.abs(gx), isa.splat(reach.x)),
                isa.mul(isa.abs(gy), isa.splat(reach.y)),
            ),
            isa.mul(isa.abs(gz), isa.splat(reach.z)),
        );
        *at = (isa.sub(middle, reach), isa.add(middle, reach));
    }
    let (s0, s1) = (smooth(from.z), smooth(to.z));
    let low = isa.store(isa.min(
        mix(isa, at[0].0, at[1].0, s0),
        mix(isa, at[0].0, at[1].0, s1),
    ));
    let high = isa.store(isa.max(
        mix(isa, at[0].1, at[1].1, s0),
        mix(isa, at[0].1, at[1].1, s1),
    ));
    let (s0, s1) = (smooth(from.y), smooth(to.y));
    let lower = blend((low[0], high[0]), (low[1], high[1]), s0, s1);
    let upper = blend((low[2], high[2]), (low[3], high[3]), s0, s1);
    blend(lower, upper, smooth(from.x), smooth(to.x))
}

#[inline(always)]
fn mix<I: Isa>(isa: I, a: I::F64x4, b: I::F64x4, s: f64) -> I::F64x4 {
    isa.add(isa.mul(a, isa.splat(1.0 - s)), isa.mul(b, isa.splat(s)))
}

/// Bounds of `a + s (b - a)` for a share between `s0` and `s1`: it is linear in the share, so an end is extreme.
#[inline(always)]
fn blend(a: Range, b: Range, s0: f64, s1: f64) -> Range {
    let mix = |a: f64, b: f64, s: f64| a * (1.0 - s) + b * s;
    let low = mix(a.0, b.0, s0).min(mix(a.0, b.0, s1));
    let high = mix(a.1, b.1, s0).max(mix(a.1, b.1, s1));
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::super::noise;
    use super::*;

    #[test]
    fn bounds_hold_and_close_in_on_the_value() {
        use NoiseGenerator::{Original, Perlin, RangeCorrected};
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut cube = || DVec3::new(random(), random(), random());
        for generator in [Original, RangeCorrected, Perlin] {
            for size in [0.9, 0.3, 0.05, 1e-3, 0.0] {
                let mut widest: f64 = 0.0;
                for _ in 0..300 {
                    let min = (cube() - DVec3::splat(0.5)) * 60.0;
                    let max = min + cube() * size;
                    let (low, high) = noise_bounds(min, max, generator);
                    for simd in Simd::available() {
                        let found = dispatch!(simd, isa => within(isa, min, max, generator));
                        assert_eq!(found, (low, high), "{simd:?}");
                    }
                    widest = widest.max(high - low);
                    for _ in 0..20 {
                        let value = noise(min + (max - min) * cube(), generator);
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
