//! Noise on the plane `y = 0` with its slopes, and what both can be over a rectangle: for terrains.
//!
//! A corner of a cell of the plane carries a linear function of two variables: that of the lattice's corner, or what the blend along
//! y makes of two of them. So a terrain needs four corners where the noise in space has eight.

use super::kernel::{CELL_SHIFT, OVERFLOW};
use super::tables::{GRADIENTS, VALUES, hash};
use super::{NoiseGenerator, SHIFT, perlin_row, smooth};

/// More than the rounding errors of noise and its slopes, whose terms are of the size of 1.
const ROUNDING: f64 = 1e-12;

/// A bound of the slopes along x and z: corners differ by at most 5, the blend has a slope of at most 1.5, a corner one of at most 1.
const STEEPEST: f64 = 8.5;

/// Two numbers, the lower one first.
type Range = (f64, f64);

/// Noise and its slopes along x and z, or what they are within.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneNoise<T> {
    /// The noise, `0..=1`.
    pub value: T,
    /// Its derivatives by x and by z.
    pub slopes: [T; 2],
}

/// What a corner carries: `value + x dx + z dz`.
type Corner = [f64; 3];

/// The four corners of a cell; corner `2 i + k` is the lower (0) or upper (1) one along x and along z.
#[inline(always)]
fn corners(cell: [f64; 2], generator: NoiseGenerator) -> [Corner; 4] {
    // The casts are exact: cells are whole and within the range of 32-bit integers.
    let [i, k] = [cell[0] as i64, cell[1] as i64];
    let mut all = [[0.0; 3]; 4];
    if generator == NoiseGenerator::Perlin {
        let (j, y) = (WHOLE as usize & 2047, SHIFT - WHOLE);
        let upper = smooth(y);
        let (i, k) = (i + WHOLE as i64, k + WHOLE as i64);
        for (n, corner) in all.iter_mut().enumerate() {
            let i = (i + (n >> 1) as i64) as usize & 2047;
            let k = (k + (n & 1) as i64) as usize & 2047;
            let low = GRADIENTS[(perlin_row(i, j) + k) & 2047];
            let high = GRADIENTS[(perlin_row(i, (j + 1) & 2047) + k) & 2047];
            let mix = |a: f64, b: f64| (1.0 - upper) * a + upper * b;
            *corner = [
                mix(low.y * y, high.y * (y - 1.0)),
                mix(low.x, high.x),
                mix(low.z, high.z),
            ];
        }
        return all;
    }
    let shifted = |c: i64| (c + i64::from(CELL_SHIFT)) as usize & 4095;
    let j = CELL_SHIFT as usize & 4095;
    for (n, corner) in all.iter_mut().enumerate() {
        let row = usize::from(hash(shifted(i + (n >> 1) as i64)));
        let column = usize::from(hash(row ^ j));
        let h = usize::from(hash(column ^ shifted(k + (n & 1) as i64)) & 255);
        *corner = [VALUES[0][h], VALUES[1][h], VALUES[3][h]];
    }
    all
}

/// What the sum over the corners is multiplied by, after adding something.
const fn scale(generator: NoiseGenerator) -> (f64, f64) {
    match generator {
        NoiseGenerator::Original => (0.5, 1.0),
        NoiseGenerator::RangeCorrected => (1.05242, 0.48985582),
        NoiseGenerator::Perlin => (0.4925 / 0.795, 0.795),
    }
}

/// What coordinates are shifted by. The whole part of the gradient noise's shift is added to the numbers of cells, so that coordinates
/// keep all their bits: near the origin terrains have no steps.
fn shift(generator: NoiseGenerator) -> f64 {
    match generator {
        NoiseGenerator::Perlin => SHIFT - WHOLE,
        _ => 0.0,
    }
}

/// The whole part of the shift of the gradient noise.
const WHOLE: f64 = 10_000_000.0;

/// The derivative of the blend.
#[inline(always)]
fn smooth_slope(t: f64) -> f64 {
    6.0 * t * (1.0 - t)
}

/// The noise [`noise`](super::noise) at `(x, 0, z)` up to rounding (of coordinates, which the gradient noise rounds to 2⁻²⁹ there, and not
/// here), and its slopes; where a coordinate is beyond 2³¹, or no number, it
/// is 1/2.
pub fn plane_noise(x: f64, z: f64, generator: NoiseGenerator) -> PlaneNoise<f64> {
    let (x, z) = (x + shift(generator), z + shift(generator));
    if !(x.abs() < OVERFLOW && z.abs() < OVERFLOW) {
        return PlaneNoise {
            value: 0.5,
            slopes: [0.0; 2],
        };
    }
    let cell = [x.floor(), z.floor()];
    let (u, v) = (x - cell[0], z - cell[1]);
    let (s, t) = (smooth(u), smooth(v));
    let all = corners(cell, generator);
    let at = |n: usize, u: f64, v: f64| {
        let [value, a, b] = all[n];
        value + (a * u + b * v)
    };
    let (a, b) = (at(0, u, v), at(1, u, v - 1.0));
    let (c, d) = (at(2, u - 1.0, v), at(3, u - 1.0, v - 1.0));
    let mix = |a: f64, b: f64, share: f64| a * (1.0 - share) + b * share;
    let (low, high) = (mix(a, b, t), mix(c, d, t));
    let blend = |k: usize| {
        mix(
            mix(all[0][k], all[1][k], t),
            mix(all[2][k], all[3][k], t),
            s,
        )
    };
    let dx = smooth_slope(u) * (high - low) + blend(1);
    let dz = smooth_slope(v) * mix(b - a, d - c, s) + blend(2);
    let (add, factor) = scale(generator);
    let value = (mix(low, high, s) + add) * factor;
    if value > 0.0 && value < 1.0 {
        PlaneNoise {
            value,
            slopes: [dx * factor, dz * factor],
        }
    } else {
        PlaneNoise {
            value: if value > 0.5 { 1.0 } else { 0.0 },
            slopes: [0.0; 2],
        }
    }
}

/// Bounds of [`plane_noise`] over the rectangle of these ranges of x and z: exact for points, the full range for rectangles that
/// reach over more than two cells of the lattice.
pub fn plane_noise_bounds(x: Range, z: Range, generator: NoiseGenerator) -> PlaneNoise<Range> {
    let full = PlaneNoise {
        value: (0.0, 1.0),
        slopes: [(-STEEPEST, STEEPEST); 2],
    };
    let by = shift(generator);
    let (x, z) = ((x.0 + by, x.1 + by), (z.0 + by, z.1 + by));
    let is_known = |(a, b): Range| a > -OVERFLOW && b < OVERFLOW && a <= b;
    if !(is_known(x) && is_known(z)) {
        return full;
    }
    let (first, last) = ([x.0.floor(), z.0.floor()], [x.1.floor(), z.1.floor()]);
    if last[0] - first[0] > 1.0 || last[1] - first[1] > 1.0 {
        return full;
    }
    let mut hull: Option<PlaneNoise<Range>> = None;
    let mut i = first[0];
    while i <= last[0] {
        let mut k = first[1];
        while k <= last[1] {
            let part = |(a, b): Range, cell: f64| {
                let (a, b) = (a - cell, b - cell);
                (if a > 0.0 { a } else { 0.0 }, if b < 1.0 { b } else { 1.0 })
            };
            let one = in_cell([i, k], part(x, i), part(z, k), generator);
            hull = Some(match hull {
                None => one,
                Some(other) => PlaneNoise {
                    value: join(one.value, other.value),
                    slopes: [
                        join(one.slopes[0], other.slopes[0]),
                        join(one.slopes[1], other.slopes[1]),
                    ],
                },
            });
            k += 1.0;
        }
        i += 1.0;
    }
    hull.map_or(full, |found| finished(found, generator))
}

/// From the sum over the corners to the noise, widened for rounding and cut off at 0 and 1.
fn finished(raw: PlaneNoise<Range>, generator: NoiseGenerator) -> PlaneNoise<Range> {
    let (add, factor) = scale(generator);
    let low = (raw.value.0 + add) * factor - ROUNDING;
    let high = (raw.value.1 + add) * factor + ROUNDING;
    let is_cut = low <= 0.0 || high >= 1.0;
    let slope = |(a, b): Range| {
        let (a, b) = (a * factor - ROUNDING, b * factor + ROUNDING);
        // Where it is cut off, noise is flat.
        if is_cut {
            join((a, b), (0.0, 0.0))
        } else {
            (a, b)
        }
    };
    let cut = |x: f64| {
        if x > 0.0 {
            if x < 1.0 { x } else { 1.0 }
        } else {
            0.0
        }
    };
    PlaneNoise {
        value: (cut(low), cut(high)),
        slopes: [slope(raw.slopes[0]), slope(raw.slopes[1])],
    }
}

#[inline(always)]
fn join(a: Range, b: Range) -> Range {
    (
        if a.0 < b.0 { a.0 } else { b.0 },
        if a.1 > b.1 { a.1 } else { b.1 },
    )
}

/// Bounds of `a + s (b - a)` for a share in a range: it is linear in the share, so an end is extreme.
#[inline(always)]
fn blend(a: Range, b: Range, s: Range) -> Range {
    let mix = |a: f64, b: f64, s: f64| a * (1.0 - s) + b * s;
    let low = (mix(a.0, b.0, s.0), mix(a.0, b.0, s.1));
    let high = (mix(a.1, b.1, s.0), mix(a.1, b.1, s.1));
    (
        if low.0 < low.1 { low.0 } else { low.1 },
        if high.0 > high.1 { high.0 } else { high.1 },
    )
}

/// The product of a range and one that is not negative.
#[inline(always)]
fn product((a, b): Range, (low, high): Range) -> Range {
    (
        if a < 0.0 { a * high } else { a * low },
        if b > 0.0 { b * high } else { b * low },
    )
}

/// The range of the slope of the blend between two positions in a cell.
#[inline(always)]
fn slope_range((a, b): Range) -> Range {
    let (at_a, at_b) = (smooth_slope(a), smooth_slope(b));
    let low = if at_a < at_b { at_a } else { at_b };
    let high = if at_a > at_b { at_a } else { at_b };
    // The greatest slope is in the middle.
    let high = if a < 0.5 && b > 0.5 { 1.5 } else { high };
    (if low > 0.0 { low } else { 0.0 }, high)
}

/// Bounds of the sum over the corners in a part of one cell, both ranges in `0..=1`.
#[inline(always)]
fn in_cell(cell: [f64; 2], u: Range, v: Range, generator: NoiseGenerator) -> PlaneNoise<Range> {
    let all = corners(cell, generator);
    let middle = [0.5 * (u.0 + u.1), 0.5 * (v.0 + v.1)];
    let reach = [0.5 * (u.1 - u.0), 0.5 * (v.1 - v.0)];
    let at = |n: usize| {
        let [value, a, b] = all[n];
        let away = [(n >> 1) as f64, (n & 1) as f64];
        let middle = value + (a * (middle[0] - away[0]) + b * (middle[1] - away[1]));
        let reach = a.abs() * reach[0] + b.abs() * reach[1];
        (middle - reach, middle + reach)
    };
    // How much larger corner `n` is than corner `m`, less the part that is linear in both.
    let rise = |m: usize, n: usize| {
        let away = |n: usize| [(n >> 1) as f64, (n & 1) as f64];
        let corner = |n: usize| {
            let [value, a, b] = all[n];
            value + (a * (middle[0] - away(n)[0]) + b * (middle[1] - away(n)[1]))
        };
        let difference = corner(n) - corner(m);
        let reach =
            (all[n][1] - all[m][1]).abs() * reach[0] + (all[n][2] - all[m][2]).abs() * reach[1];
        (difference - reach, difference + reach)
    };
    let (s, t) = ((smooth(u.0), smooth(u.1)), (smooth(v.0), smooth(v.1)));
    let (low, high) = (blend(at(0), at(1), t), blend(at(2), at(3), t));
    let gradient = |k: usize| {
        let point = |n: usize| (all[n][k], all[n][k]);
        blend(
            blend(point(0), point(1), t),
            blend(point(2), point(3), t),
            s,
        )
    };
    let sum = |a: Range, b: Range| (a.0 + b.0, a.1 + b.1);
    PlaneNoise {
        value: blend(low, high, s),
        slopes: [
            sum(
                product(blend(rise(0, 2), rise(1, 3), t), slope_range(u)),
                gradient(1),
            ),
            sum(
                product(blend(rise(0, 1), rise(2, 3), s), slope_range(v)),
                gradient(2),
            ),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::super::noise;
    use super::*;
    use crate::DVec3;

    const GENERATORS: [NoiseGenerator; 3] = [
        NoiseGenerator::Original,
        NoiseGenerator::RangeCorrected,
        NoiseGenerator::Perlin,
    ];

    fn random() -> impl FnMut() -> f64 {
        let mut seed = 1_u64;
        move || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    #[test]
    fn it_is_the_noise_of_space_and_its_slopes_are_differences() {
        let mut random = random();
        for generator in GENERATORS {
            for _ in 0..3000 {
                let (x, z) = (200.0 * random() - 100.0, 200.0 * random() - 100.0);
                let found = plane_noise(x, z, generator);
                let value = noise(DVec3::new(x, 0.0, z), generator);
                let rounding = if generator == NoiseGenerator::Perlin {
                    1e-8
                } else {
                    1e-14
                };
                assert!(
                    (found.value - value).abs() < rounding,
                    "{generator:?} {x} {z}"
                );
                let step = 1.0 / 4096.0;
                for (k, (dx, dz)) in [(step, 0.0), (0.0, step)].into_iter().enumerate() {
                    let ahead = plane_noise(x + dx, z + dz, generator).value;
                    let behind = plane_noise(x - dx, z - dz, generator).value;
                    let difference = (ahead - behind) / (2.0 * step);
                    let off = (difference - found.slopes[k]).abs();
                    // Near the border of a cell the curvature jumps, near a plateau the slope.
                    let is_plateau = !(1e-2..=0.99).contains(&value);
                    assert!(off < 4e-3 || is_plateau, "{generator:?} {x} {z}: {off}");
                }
            }
        }
    }

    #[test]
    fn bounds_hold_and_close_in_on_value_and_slopes() {
        let mut random = random();
        for generator in GENERATORS {
            for size in [3.0, 0.9, 0.3, 0.05, 1e-3, 0.0] {
                let mut widest: f64 = 0.0;
                for _ in 0..300 {
                    let mut range = || {
                        let low = 60.0 * (random() - 0.5);
                        (low, low + size * random())
                    };
                    let (x, z) = (range(), range());
                    let bounds = plane_noise_bounds(x, z, generator);
                    let all = [bounds.value, bounds.slopes[0], bounds.slopes[1]];
                    for (low, high) in all {
                        widest = widest.max(high - low);
                    }
                    for _ in 0..20 {
                        let mut at = |(a, b): Range| a + (b - a) * random();
                        let found = plane_noise(at(x), at(z), generator);
                        let found = [found.value, found.slopes[0], found.slopes[1]];
                        for ((low, high), value) in all.into_iter().zip(found) {
                            assert!(low <= value && value <= high, "{value} {all:?} {x:?} {z:?}");
                        }
                    }
                }
                // Plateaus of the first generator widen slopes of small rectangles to zero.
                if size < 0.1 && generator != NoiseGenerator::Original {
                    assert!(
                        widest <= 24.0 * size + 1e-11,
                        "{generator:?} {size}: {widest}"
                    );
                }
            }
        }
    }

    #[test]
    fn strange_rectangles_have_the_full_range() {
        for range in [
            (0.0, 3.5),
            (f64::NAN, 1.0),
            (0.0, f64::INFINITY),
            (1.0, 0.0),
        ] {
            let bounds = plane_noise_bounds(range, (0.0, 0.1), NoiseGenerator::Perlin);
            assert_eq!(bounds.value, (0.0, 1.0));
        }
        let far = plane_noise(1e300, f64::NAN, NoiseGenerator::Original);
        assert_eq!((far.value, far.slopes), (0.5, [0.0; 2]));
    }
}
