//! Noise on the plane `y = 0` with its slopes, and what both can be over a rectangle: for terrains.
//!
//! A corner of a cell of the plane carries a linear function of two variables: that of the lattice's corner, or what the blend along
//! y makes of two of them. So a terrain needs four corners where the noise in space has eight. Four octaves are computed at once,
//! one in each lane.

use super::kernel::{CELL_SHIFT, OVERFLOW, floor, whole};
use super::tables::{CORNERS, GRADIENTS, hash};
use super::{NoiseGenerator, SHIFT, perlin_row, smooth};
use strahl_simd::Isa;

/// More than the rounding errors of noise and its slopes, whose terms are of the size of 1.
const ROUNDING: f64 = 1e-12;

/// A bound of the slopes along x and z: corners differ by at most 5, the blend has a slope of at most 1.5, a corner one of at most 1.
const STEEPEST: f64 = 8.5;

/// Two numbers, the lower one first; vectors of them in kernels.
type Range<T = f64> = (T, T);

/// Noise and its slopes along x and z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneNoise<T> {
    /// The noise, `0..=1`.
    pub value: T,
    /// Its derivatives by x and by z.
    pub slopes: [T; 2],
}

/// What noise and its slopes along x and z are within over a rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneBounds {
    /// The range of the noise, within `0..=1`.
    pub value: Range,
    /// The ranges of its derivatives by x and by z.
    pub slopes: [Range; 2],
    /// The noise in the middle of the rectangle, if that is known.
    pub middle: f64,
}

/// What a corner carries: `value + x dx + z dz`.
type Corner<T> = [T; 3];

/// The four corners of a cell; corner `2 i + k` is the lower (0) or upper (1) one along x and along z. The third lanes mean nothing.
#[inline(always)]
fn corners<I: Isa>(isa: I, cell: [f64; 2], generator: NoiseGenerator) -> [I::F64x4; 4] {
    let [i, k] = [whole(cell[0]), whole(cell[1])];
    let mut all = [isa.splat(0.0); 4];
    if generator == NoiseGenerator::Perlin {
        let (j, y) = (WHOLE as usize & 2047, SHIFT - WHOLE);
        let upper = smooth(y);
        for (n, corner) in all.iter_mut().enumerate() {
            let (i, k) = ((i + j + (n >> 1)) & 2047, (k + j + (n & 1)) & 2047);
            let low = GRADIENTS[(perlin_row(i, j) + k) & 2047];
            let high = GRADIENTS[(perlin_row(i, (j + 1) & 2047) + k) & 2047];
            let low = isa.load(&[low.y * y, low.x, 0.0, low.z]);
            let high = isa.load(&[high.y * (y - 1.0), high.x, 0.0, high.z]);
            *corner = isa.add(
                isa.mul(isa.splat(1.0 - upper), low),
                isa.mul(isa.splat(upper), high),
            );
        }
        return all;
    }
    let j = CELL_SHIFT as usize & 4095;
    for a in 0..2 {
        let row = usize::from(hash((i + j + a) & 4095));
        let column = usize::from(hash(row ^ j));
        for b in 0..2 {
            let h = usize::from(hash(column ^ (k + j + b) & 4095) & 255);
            all[2 * a + b] = isa.load(&CORNERS.0[h]);
        }
    }
    all
}

/// The corners of four cells.
#[inline(always)]
fn corners_of_four<I: Isa>(
    isa: I,
    [x, z]: [&[f64; 4]; 2],
    generator: NoiseGenerator,
) -> [Corner<I::F64x4>; 4] {
    let zero = isa.splat(0.0);
    let mut cells = [[zero; 4]; 4];
    for lane in 0..4 {
        cells[lane] = corners(isa, [x[lane], z[lane]], generator);
    }
    let [a, b, c, d] = cells;
    let mut all = [[zero; 3]; 4];
    for n in 0..4 {
        let [value, by_x, _, by_z] = isa.transpose([a[n], b[n], c[n], d[n]]);
        all[n] = [value, by_x, by_z];
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

/// [`floor`] of four numbers.
#[inline(always)]
fn floors<I: Isa>(x: &[f64; 4]) -> [f64; 4] {
    let mut all = [0.0; 4];
    for lane in 0..4 {
        all[lane] = floor::<I>(x[lane]);
    }
    all
}

/// `3 t² - 2 t³`.
#[inline(always)]
fn smooth_of_four<I: Isa>(isa: I, t: I::F64x4) -> I::F64x4 {
    let square = isa.mul(t, t);
    isa.mul(square, isa.sub(isa.splat(3.0), isa.mul(isa.splat(2.0), t)))
}

/// Its derivative.
#[inline(always)]
fn smooth_slope<I: Isa>(isa: I, t: I::F64x4) -> I::F64x4 {
    let rest = isa.sub(isa.splat(1.0), t);
    isa.mul(isa.mul(isa.splat(6.0), t), rest)
}

/// `a (1 - share) + b share`.
#[inline(always)]
fn mix<I: Isa>(isa: I, a: I::F64x4, b: I::F64x4, share: I::F64x4) -> I::F64x4 {
    let rest = isa.sub(isa.splat(1.0), share);
    isa.add(isa.mul(a, rest), isa.mul(b, share))
}

/// The way from corner `n` of a cell to a place in it, along x and z.
#[inline(always)]
fn way<I: Isa>(isa: I, n: usize, place: [I::F64x4; 2]) -> [I::F64x4; 2] {
    let one = isa.splat(1.0);
    [
        if n >> 1 == 0 {
            place[0]
        } else {
            isa.sub(place[0], one)
        },
        if n & 1 == 0 {
            place[1]
        } else {
            isa.sub(place[1], one)
        },
    ]
}

/// What a corner carries to a place that is this way from it.
#[inline(always)]
fn carried<I: Isa>(isa: I, corner: &Corner<I::F64x4>, way: [I::F64x4; 2]) -> I::F64x4 {
    let [value, a, b] = *corner;
    isa.add(value, isa.add(isa.mul(a, way[0]), isa.mul(b, way[1])))
}

/// At four places `(x, 0, z)`, the noise [`noise`](super::noise) up to rounding (of coordinates, which the gradient noise rounds to
/// 2⁻²⁹ there, and not here), and its slopes; where a coordinate is beyond 2³¹, or no number, it is 1/2.
#[inline(always)]
pub fn plane_noise<I: Isa>(
    isa: I,
    x: &[f64; 4],
    z: &[f64; 4],
    generator: NoiseGenerator,
) -> PlaneNoise<I::F64x4> {
    let by = shift(generator);
    let (mut x, mut z, mut unknown) = (*x, *z, [0.0; 4]);
    for lane in 0..4 {
        (x[lane], z[lane]) = (x[lane] + by, z[lane] + by);
        if !(x[lane].abs() < OVERFLOW && z[lane].abs() < OVERFLOW) {
            (x[lane], z[lane], unknown[lane]) = (0.0, 0.0, 1.0);
        }
    }
    let (i, k) = (floors::<I>(&x), floors::<I>(&z));
    let all = corners_of_four(isa, [&i, &k], generator);
    let u = isa.sub(isa.load(&x), isa.load(&i));
    let v = isa.sub(isa.load(&z), isa.load(&k));
    let (s, t) = (smooth_of_four(isa, u), smooth_of_four(isa, v));
    let mut at = [u; 4];
    for n in 0..4 {
        at[n] = carried(isa, &all[n], way(isa, n, [u, v]));
    }
    let [a, b, c, d] = at;
    let (low, high) = (mix(isa, a, b, t), mix(isa, c, d, t));
    let mut slopes = [
        isa.mul(smooth_slope(isa, u), isa.sub(high, low)),
        isa.mul(
            smooth_slope(isa, v),
            mix(isa, isa.sub(b, a), isa.sub(d, c), s),
        ),
    ];
    let (add, factor) = scale(generator);
    let (add, factor) = (isa.splat(add), isa.splat(factor));
    let value = isa.mul(isa.add(mix(isa, low, high, s), add), factor);
    let (zero, one, half) = (isa.splat(0.0), isa.splat(1.0), isa.splat(0.5));
    let unknown = isa.load(&unknown);
    for k in 0..2 {
        let blend = mix(
            isa,
            mix(isa, all[0][k + 1], all[1][k + 1], t),
            mix(isa, all[2][k + 1], all[3][k + 1], t),
            s,
        );
        let slope = isa.mul(isa.add(slopes[k], blend), factor);
        // Where it is cut off, noise is flat.
        let slope = isa.choose_le(value, zero, zero, slope);
        let slope = isa.choose_le(one, value, zero, slope);
        slopes[k] = isa.choose_le(one, unknown, zero, slope);
    }
    let value = isa.min(isa.max(value, zero), one);
    PlaneNoise {
        value: isa.choose_le(one, unknown, half, value),
        slopes,
    }
}

/// So many octaves may be bounded at once.
const AT_ONCE: usize = 8;

/// Bounds of [`plane_noise`] over a rectangle, given by its ranges of x and z, times each of some frequencies, which are positive: exact for points, the full range
/// for rectangles that reach over more than two cells of the lattice.
///
/// # Panics
/// There are more than eight frequencies.
#[inline(always)]
pub fn plane_noise_bounds<I: Isa>(
    isa: I,
    x: Range,
    z: Range,
    frequencies: &[f64],
    generator: NoiseGenerator,
    out: &mut [PlaneBounds; AT_ONCE],
) {
    let mut parts = Parts {
        isa,
        generator,
        cells: [[0.0; 4]; 2],
        places: [[0.0; 4]; 4],
        octaves: [0; 4],
        count: 0,
    };
    let by = shift(generator);
    for n in 0..frequencies.len() {
        let f = frequencies[n];
        // Rounded products are monotone, so no point of the rectangle is mapped out of this one.
        let (x, z) = ((x.0 * f + by, x.1 * f + by), (z.0 * f + by, z.1 * f + by));
        let is_known = is_known(x) && is_known(z);
        let first = [floor::<I>(x.0), floor::<I>(z.0)];
        let last = [floor::<I>(x.1), floor::<I>(z.1)];
        if !(is_known && last[0] - first[0] <= 1.0 && last[1] - first[1] <= 1.0) {
            out[n] = FULL;
            continue;
        }
        out[n] = NONE;
        let mut i = first[0];
        while i <= last[0] {
            let mut k = first[1];
            while k <= last[1] {
                parts.add(n, [i, k], [x.0, x.1, z.0, z.1], out);
                k += 1.0;
            }
            i += 1.0;
        }
    }
    parts.bound(out);
}

/// Anything.
const FULL: PlaneBounds = PlaneBounds {
    value: (0.0, 1.0),
    slopes: [(-STEEPEST, STEEPEST); 2],
    middle: f64::NAN,
};

/// The bounds of nothing.
const NONE: PlaneBounds = PlaneBounds {
    value: (f64::INFINITY, f64::NEG_INFINITY),
    slopes: [(f64::INFINITY, f64::NEG_INFINITY); 2],
    middle: f64::NAN,
};

/// Bounds over four rectangles.
struct FourBounds<I: Isa> {
    value: Range<I::F64x4>,
    slopes: [Range<I::F64x4>; 2],
    /// In the middle of the rectangle, if that is in the cell.
    middle: I::F64x4,
}

/// Whether lattices have cells for a range.
#[inline(always)]
fn is_known((a, b): Range) -> bool {
    a > -OVERFLOW && b < OVERFLOW && a <= b
}

/// Parts of rectangles, each in one cell of its octave, until there are four of them.
struct Parts<I: Isa> {
    isa: I,
    generator: NoiseGenerator,
    /// The cells, along x and z.
    cells: [[f64; 4]; 2],
    /// The ends of the rectangles along x and z.
    places: [[f64; 4]; 4],
    octaves: [usize; 4],
    count: usize,
}

impl<I: Isa> Parts<I> {
    #[inline(always)]
    fn add(
        &mut self,
        octave: usize,
        cell: [f64; 2],
        place: [f64; 4],
        out: &mut [PlaneBounds; AT_ONCE],
    ) {
        if self.count == 4 {
            self.bound(out);
        }
        let lane = self.count;
        (self.cells[0][lane], self.cells[1][lane]) = (cell[0], cell[1]);
        (self.places[0][lane], self.places[1][lane]) = (place[0], place[1]);
        (self.places[2][lane], self.places[3][lane]) = (place[2], place[3]);
        self.octaves[lane] = octave;
        self.count += 1;
    }

    /// Joins the bounds over the parts to those of their octaves.
    #[inline(always)]
    fn bound(&mut self, out: &mut [PlaneBounds; AT_ONCE]) {
        let isa = self.isa;
        let [x0, x1, z0, z1] = &self.places;
        let x = (isa.load(x0), isa.load(x1));
        let z = (isa.load(z0), isa.load(z1));
        let [i, k] = &self.cells;
        let found = finished(
            isa,
            over_cells(isa, [i, k], x, z, self.generator),
            self.generator,
        );
        let value = stored(isa, found.value);
        let slopes = [stored(isa, found.slopes[0]), stored(isa, found.slopes[1])];
        let middles = isa.store(found.middle);
        for lane in 0..self.count {
            let own = &mut out[self.octaves[lane]];
            let is_within = |axis: usize| {
                let [low, high] = [&self.places[2 * axis], &self.places[2 * axis + 1]];
                let from = 0.5 * (low[lane] + high[lane]) - self.cells[axis][lane];
                (0.0..=1.0).contains(&from)
            };
            if is_within(0) && is_within(1) {
                own.middle = middles[lane];
            }
            own.value = join(own.value, (value.0[lane], value.1[lane]));
            let [by_x, by_z] = &slopes;
            own.slopes[0] = join(own.slopes[0], (by_x.0[lane], by_x.1[lane]));
            own.slopes[1] = join(own.slopes[1], (by_z.0[lane], by_z.1[lane]));
        }
        self.count = 0;
    }
}

#[inline(always)]
fn stored<I: Isa>(isa: I, range: Range<I::F64x4>) -> Range<[f64; 4]> {
    (isa.store(range.0), isa.store(range.1))
}

#[inline(always)]
fn join(a: Range, b: Range) -> Range {
    (
        if a.0 < b.0 { a.0 } else { b.0 },
        if a.1 > b.1 { a.1 } else { b.1 },
    )
}

/// From the sum over the corners to the noise, widened for rounding and cut off at 0 and 1.
#[inline(always)]
fn finished<I: Isa>(isa: I, raw: FourBounds<I>, generator: NoiseGenerator) -> FourBounds<I> {
    let (add, factor) = scale(generator);
    let (add, factor, pad) = (isa.splat(add), isa.splat(factor), isa.splat(ROUNDING));
    let (zero, one) = (isa.splat(0.0), isa.splat(1.0));
    let low = isa.sub(isa.mul(isa.add(raw.value.0, add), factor), pad);
    let high = isa.add(isa.mul(isa.add(raw.value.1, add), factor), pad);
    let mut slopes = raw.slopes;
    for (a, b) in &mut slopes {
        (*a, *b) = (
            isa.sub(isa.mul(*a, factor), pad),
            isa.add(isa.mul(*b, factor), pad),
        );
        // Where it is cut off, noise is flat.
        let cut = (isa.min(*a, zero), isa.max(*b, zero));
        *a = isa.choose_le(low, zero, cut.0, isa.choose_le(one, high, cut.0, *a));
        *b = isa.choose_le(low, zero, cut.1, isa.choose_le(one, high, cut.1, *b));
    }
    FourBounds {
        value: (
            isa.min(isa.max(low, zero), one),
            isa.min(isa.max(high, zero), one),
        ),
        slopes,
        middle: isa.min(
            isa.max(isa.mul(isa.add(raw.middle, add), factor), zero),
            one,
        ),
    }
}

#[inline(always)]
fn sum<I: Isa>(isa: I, a: Range<I::F64x4>, b: Range<I::F64x4>) -> Range<I::F64x4> {
    (isa.add(a.0, b.0), isa.add(a.1, b.1))
}

/// Bounds of `a + s (b - a)` for a share in a range: it is linear in the share, so an end is extreme.
#[inline(always)]
fn blend<I: Isa>(
    isa: I,
    a: Range<I::F64x4>,
    b: Range<I::F64x4>,
    s: Range<I::F64x4>,
) -> Range<I::F64x4> {
    (
        isa.min(mix(isa, a.0, b.0, s.0), mix(isa, a.0, b.0, s.1)),
        isa.max(mix(isa, a.1, b.1, s.0), mix(isa, a.1, b.1, s.1)),
    )
}

/// The product of a range and one that is not negative.
#[inline(always)]
fn product<I: Isa>(
    isa: I,
    (a, b): Range<I::F64x4>,
    (low, high): Range<I::F64x4>,
) -> Range<I::F64x4> {
    let zero = isa.splat(0.0);
    (
        isa.choose_le(zero, a, isa.mul(a, low), isa.mul(a, high)),
        isa.choose_le(b, zero, isa.mul(b, low), isa.mul(b, high)),
    )
}

/// The range of the slope of the blend between two positions in a cell.
#[inline(always)]
fn slope_range<I: Isa>(isa: I, (a, b): Range<I::F64x4>) -> Range<I::F64x4> {
    let (at_a, at_b) = (smooth_slope(isa, a), smooth_slope(isa, b));
    let (low, high) = (isa.min(at_a, at_b), isa.max(at_a, at_b));
    // The greatest slope is in the middle.
    let (half, most) = (isa.splat(0.5), isa.splat(1.5));
    let high = isa.choose_le(half, a, high, isa.choose_le(b, half, high, most));
    (isa.max(low, isa.splat(0.0)), high)
}

/// Bounds of the sum over the corners in the parts of rectangles that are in these cells.
#[inline(always)]
fn over_cells<I: Isa>(
    isa: I,
    [i, k]: [&[f64; 4]; 2],
    x: Range<I::F64x4>,
    z: Range<I::F64x4>,
    generator: NoiseGenerator,
) -> FourBounds<I> {
    let all = corners_of_four(isa, [i, k], generator);
    let (zero, one, half) = (isa.splat(0.0), isa.splat(1.0), isa.splat(0.5));
    let (i, k) = (isa.load(i), isa.load(k));
    let u = (
        isa.max(isa.sub(x.0, i), zero),
        isa.min(isa.sub(x.1, i), one),
    );
    let v = (
        isa.max(isa.sub(z.0, k), zero),
        isa.min(isa.sub(z.1, k), one),
    );
    let middle = [
        isa.mul(half, isa.add(u.0, u.1)),
        isa.mul(half, isa.add(v.0, v.1)),
    ];
    let reach = [
        isa.mul(half, isa.sub(u.1, u.0)),
        isa.mul(half, isa.sub(v.1, v.0)),
    ];
    // What the corners carry: in the middle, and around it.
    let mut carry = [zero; 4];
    let mut at = [(zero, zero); 4];
    for n in 0..4 {
        carry[n] = carried(isa, &all[n], way(isa, n, middle));
        let off = around(isa, all[n][1], all[n][2], reach);
        at[n] = (isa.sub(carry[n], off), isa.add(carry[n], off));
    }
    // How much larger a corner is than one before it, along x and along z.
    let mut rises = [[(zero, zero); 2]; 2];
    let pairs = [[(0, 2), (1, 3)], [(0, 1), (2, 3)]];
    for axis in 0..2 {
        for pair in 0..2 {
            let (m, n) = pairs[axis][pair];
            let difference = isa.sub(carry[n], carry[m]);
            let slopes = [isa.sub(all[n][1], all[m][1]), isa.sub(all[n][2], all[m][2])];
            let off = around(isa, slopes[0], slopes[1], reach);
            rises[axis][pair] = (isa.sub(difference, off), isa.add(difference, off));
        }
    }
    let s = (smooth_of_four(isa, u.0), smooth_of_four(isa, u.1));
    let t = (smooth_of_four(isa, v.0), smooth_of_four(isa, v.1));
    let low = blend(isa, at[0], at[1], t);
    let high = blend(isa, at[2], at[3], t);
    let mut slopes = [
        product(
            isa,
            blend(isa, rises[0][0], rises[0][1], t),
            slope_range(isa, u),
        ),
        product(
            isa,
            blend(isa, rises[1][0], rises[1][1], s),
            slope_range(isa, v),
        ),
    ];
    for k in 0..2 {
        let low = blend_of_points(isa, all[0][k + 1], all[1][k + 1], t);
        let high = blend_of_points(isa, all[2][k + 1], all[3][k + 1], t);
        slopes[k] = sum(isa, slopes[k], blend(isa, low, high, s));
    }
    // The place in the cell that is nearest to the middle of the rectangle.
    let place = [center(isa, x, i), center(isa, z, k)];
    let mut at = [zero; 4];
    for n in 0..4 {
        at[n] = carried(isa, &all[n], way(isa, n, place));
    }
    let share = smooth_of_four(isa, place[1]);
    let middle = mix(
        isa,
        mix(isa, at[0], at[1], share),
        mix(isa, at[2], at[3], share),
        smooth_of_four(isa, place[0]),
    );
    FourBounds {
        value: blend(isa, low, high, s),
        slopes,
        middle,
    }
}

/// The middle of a range, from a cell, or the end of the cell that is nearest to it.
#[inline(always)]
fn center<I: Isa>(isa: I, (a, b): Range<I::F64x4>, cell: I::F64x4) -> I::F64x4 {
    let middle = isa.sub(isa.mul(isa.splat(0.5), isa.add(a, b)), cell);
    isa.min(isa.max(middle, isa.splat(0.0)), isa.splat(1.0))
}

/// How much `a x + b z` changes at most within this reach.
#[inline(always)]
fn around<I: Isa>(isa: I, a: I::F64x4, b: I::F64x4, reach: [I::F64x4; 2]) -> I::F64x4 {
    isa.add(isa.mul(isa.abs(a), reach[0]), isa.mul(isa.abs(b), reach[1]))
}

/// [`blend`] of two numbers.
#[inline(always)]
fn blend_of_points<I: Isa>(
    isa: I,
    a: I::F64x4,
    b: I::F64x4,
    s: Range<I::F64x4>,
) -> Range<I::F64x4> {
    let (low, high) = (mix(isa, a, b, s.0), mix(isa, a, b, s.1));
    (isa.min(low, high), isa.max(low, high))
}

#[cfg(test)]
mod tests {
    use super::super::noise;
    use super::{NoiseGenerator, PlaneBounds, PlaneNoise, Range};
    use crate::DVec3;
    use strahl_simd::{Isa, Simd, dispatch};

    const GENERATORS: [NoiseGenerator; 3] = [
        NoiseGenerator::Original,
        NoiseGenerator::RangeCorrected,
        NoiseGenerator::Perlin,
    ];

    /// Noise at a place, in one of the lanes; the others have places around it.
    fn plane_noise(x: f64, z: f64, generator: NoiseGenerator) -> PlaneNoise<f64> {
        let lane = (x.to_bits() >> 20) as usize & 3;
        let beside: [f64; 4] = std::array::from_fn(|n| (n as f64 - lane as f64) * 0.7);
        let (x, z) = (beside.map(|by| x + by), beside.map(|by| z - by));
        agreed(|simd| {
            dispatch!(simd, isa => {
                let found = super::plane_noise(isa, &x, &z, generator);
                PlaneNoise {
                    value: isa.store(found.value)[lane],
                    slopes: found.slopes.map(|slope| isa.store(slope)[lane]),
                }
            })
        })
    }

    /// Bounds over a rectangle, which is one octave of many.
    fn plane_noise_bounds(x: Range, z: Range, generator: NoiseGenerator) -> PlaneBounds {
        let octave = (x.0.to_bits() >> 20) as usize & 7;
        let mut frequencies: [f64; 8] = std::array::from_fn(|n| 0.3 + n as f64);
        frequencies[octave] = 1.0;
        agreed(|simd| {
            dispatch!(simd, isa => {
                let mut found = [super::NONE; 8];
                super::plane_noise_bounds(isa, x, z, &frequencies, generator, &mut found);
                found[octave]
            })
        })
    }

    /// What all levels say. Their texts are compared: they differ as soon as a bit does, but NaN is like NaN.
    fn agreed<T: std::fmt::Debug>(result: impl Fn(Simd) -> T) -> T {
        let best = result(Simd::best());
        for simd in Simd::available() {
            let (found, expected) = (format!("{:?}", result(simd)), format!("{best:?}"));
            assert_eq!(found, expected, "{simd:?}");
        }
        best
    }

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
