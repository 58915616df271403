//! What noise can be within a box: for proofs that a function has no zero there.

use super::kernel::{CELL_SHIFT, OVERFLOW};
use super::tables::{R, hash};
use super::{NoiseGenerator, SHIFT, each, perlin_gradient, smooth, unit};
use crate::DVec3;

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
    let raw = match generator {
        NoiseGenerator::Perlin => {
            let shift = DVec3::splat(SHIFT);
            over_cells(min + shift, max + shift, |cell, corner, d| {
                let index = each(cell, |c| (c & 2047) as usize);
                linear(0.0, perlin_gradient(index, corner), d)
            })
        }
        _ => over_cells(min, max, |cell, corner, d| {
            let at = |k: usize| {
                (cell[k]
                    .wrapping_add(i64::from(CELL_SHIFT))
                    .wrapping_add(corner[k] as i64)
                    & 4095) as usize
            };
            let h = hash(usize::from(hash(usize::from(hash(at(0))) ^ at(1))) ^ at(2));
            let r = &R[usize::from(h & 255)..];
            linear(0.5 * r[0], DVec3::new(r[1], r[2], r[3]), d)
        }),
    };
    let Some((low, high)) = raw else {
        return (0.0, 1.0);
    };
    let end = |x: f64, pad: f64| {
        unit(match generator {
            NoiseGenerator::Original => x + 0.5 + pad,
            NoiseGenerator::RangeCorrected => (x + 1.05242) * 0.48985582 + pad,
            NoiseGenerator::Perlin => 0.4925 + 0.795 * x + pad,
        })
    };
    (end(low, -ROUNDING), end(high, ROUNDING))
}

/// Where a place may be, relative to a corner: the middle and how far it may be off.
struct Offset {
    middle: DVec3,
    reach: DVec3,
}

/// The range of `value + gradient · d`.
#[inline(always)]
fn linear(value: f64, gradient: DVec3, d: &Offset) -> Range {
    let middle = value + gradient.dot(d.middle);
    let reach = gradient.abs().dot(d.reach);
    (middle - reach, middle + reach)
}

/// The hull of the bounds in all cells that the box meets; `None` if they are too many or beyond the range of 32-bit integers.
fn over_cells(
    min: DVec3,
    max: DVec3,
    corner: impl Fn([i64; 3], [usize; 3], &Offset) -> Range,
) -> Option<Range> {
    let (first, last) = (min.floor(), max.floor());
    if min.cmple(DVec3::splat(-OVERFLOW)).any() || max.cmpge(DVec3::splat(OVERFLOW)).any() {
        return None;
    }
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
        let (low, high) = in_cell(each(cell.to_array(), |c| c as i64), from, to, &corner);
        hull = Some(hull.map_or((low, high), |(a, b)| (a.min(low), b.max(high))));
    }
    hull
}

/// Bounds over the part of one cell between `from` and `to`, both in the unit cube.
#[inline(always)]
fn in_cell(
    cell: [i64; 3],
    from: DVec3,
    to: DVec3,
    corner: &impl Fn([i64; 3], [usize; 3], &Offset) -> Range,
) -> Range {
    let (middle, reach) = (0.5 * (from + to), 0.5 * (to - from));
    let shares = |v: DVec3| DVec3::new(smooth(v.x), smooth(v.y), smooth(v.z));
    let (s0, s1) = (shares(from), shares(to));
    let at = |x: usize, y: usize, z: usize| {
        let step = DVec3::new(x as f64, y as f64, z as f64);
        let middle = middle - step;
        corner(cell, [x, y, z], &Offset { middle, reach })
    };
    let z = |x, y| blend(at(x, y, 0), at(x, y, 1), s0.z, s1.z);
    let y = |x| blend(z(x, 0), z(x, 1), s0.y, s1.y);
    blend(y(0), y(1), s0.x, s1.x)
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
