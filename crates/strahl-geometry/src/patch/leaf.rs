//! A piece that is not divided any more, as a ray meets it.

use strahl_math::error::{gamma, round_up_f32};
use strahl_math::{DMat3, DVec3, Interval};
use strahl_simd::Isa;

/// A piece is a leaf if its derivatives differ from their mean by this part of it at most. With a third of it the patches of subdivision surfaces
/// take three times the memory, and rays take the same time.
const FLAT: f64 = 0.3;
/// The map of a piece may differ from a linear one by this part at most for Newton's method to be certain.
pub(super) const NEARLY_LINEAR: f64 = 0.35;
/// A ray meets a piece at most once if the map differs from a linear one by less than 1; this leaves room for rounding.
const MET_ONCE: f64 = 0.9;
/// A ray that starts on a piece certainly meets it there if its slope in the frame is at most this: rounding moves the start off the piece, and the
/// hit is farther from it by this factor at most.
const STEEPEST_START: f64 = 64.0;
/// How far within the piece a hit has to be whose place is known only nearly.
const WELL_WITHIN: f64 = 1.0 / 64.0;

/// A piece over a square that is not divided any more: a frame in which it is near the square `-0.5..0.5` by `-0.5..0.5` of the plane
/// `w = 0`.
///
/// The first three lanes of the four vectors are a matrix, column by column, and a vector: `p` is at `columns p + offset` in the
/// frame. The fourth lanes are bounds of the piece in it.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub(super) struct Leaf([[f32; 4]; 4]);

const _: () = assert!(size_of::<Leaf>() == 64);

/// What is known of a piece in the frame of its leaf.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// The largest coordinates u and v of its points.
    pub(super) side: f64,
    /// The largest w of its points.
    pub(super) height: f64,
    /// How much the derivatives by both parameters together differ from the unit vectors within the plane, at most; infinite if
    /// that is not known.
    pub(super) bend: f64,
    /// How much they differ from it across the plane.
    pub(super) tilt: f64,
}

/// What a ray means for a leaf.
pub(super) enum Verdict {
    Missed,
    /// The ray meets it within the range; where exactly was not asked.
    Met,
    /// As [`Visitor::certain`](super::tree::Visitor::certain).
    Certain([f64; 2]),
    Uncertain,
}

/// What is asked about a leaf.
#[derive(Clone, Copy)]
pub(super) struct Question {
    /// Where hits are wanted.
    pub(super) range: Interval,
    /// Whether the ray starts on the piece, well within its border. This hit is not wanted.
    pub(super) starts: bool,
    /// Whether any hit will do.
    pub(super) any: bool,
}

impl Bounds {
    /// Whether no smaller pieces are needed.
    pub(super) fn is_flat(&self) -> bool {
        self.bend + self.tilt <= FLAT
    }
}

impl Leaf {
    pub(super) fn new(columns: [DVec3; 3], offset: DVec3) -> Self {
        let lanes = |v: DVec3| [v.x as f32, v.y as f32, v.z as f32, 0.0];
        let [x, y, z] = columns;
        Self([lanes(x), lanes(y), lanes(z), lanes(offset)])
    }

    /// The matrix and the offset, as they are stored.
    pub(super) fn map(&self) -> (DMat3, DVec3) {
        let vector = |[x, y, z, _]: [f32; 4]| DVec3::new(x.into(), y.into(), z.into());
        let [x, y, z, offset] = self.0;
        let matrix = DMat3::from_cols(vector(x), vector(y), vector(z));
        (matrix, vector(offset))
    }

    pub(super) fn set_bounds(&mut self, bounds: &Bounds) {
        let all = [bounds.side, bounds.bend, bounds.tilt, bounds.height];
        for (lanes, bound) in self.0.iter_mut().zip(all) {
            lanes[3] = round_up_f32(bound);
        }
    }

    /// What a ray means for the piece.
    #[inline(always)]
    pub(super) fn meet<I: Isa>(&self, isa: I, ray: &LocalRay<I>, question: Question) -> Verdict {
        let Question { range, starts, any } = question;
        let [x, y, z, offset] = &self.0;
        let (side, bend) = (f64::from(x[3]), f64::from(y[3]));
        let (tilt, height) = (f64::from(z[3]), f64::from(offset[3]));
        let columns = [isa.load_wide(x), isa.load_wide(y), isa.load_wide(z)];
        let offset = isa.load_wide(offset);
        let origin = isa.add(product(isa, &columns, &ray.origin), offset);
        let direction = product(isa, &columns, &ray.direction);
        let largest = isa.add(
            isa.add(isa.abs(columns[0]), isa.abs(columns[1])),
            isa.add(isa.abs(columns[2]), isa.abs(offset)),
        );
        let pad = isa.mul(largest, ray.noise);
        // Where the ray enters and leaves the slabs of the three axes.
        let reach = isa.add(isa.load(&[side, side, height, f64::INFINITY]), pad);
        let minus_reach = isa.sub(isa.splat(0.0), reach);
        let per = isa.div(isa.splat(1.0), direction);
        let a = isa.mul(isa.sub(minus_reach, origin), per);
        let b = isa.mul(isa.sub(reach, origin), per);
        let (enter, leave) = (isa.store(isa.min(a, b)), isa.store(isa.max(a, b)));
        let (mut near, mut far) = (range.min, range.max);
        for k in 0..3 {
            // Comparisons with NaN, when the ray runs within a side, change nothing.
            if enter[k] > near {
                near = enter[k];
            }
            if leave[k] < far {
                far = leave[k];
            }
        }
        // The ends are a quotient of rounded numbers.
        if near - near.abs() * gamma(8) > far + far.abs() * gamma(8) {
            return Verdict::Missed;
        }
        let (o, d) = (isa.store(origin), isa.store(direction));
        let slope = [d[0] / d[2], d[1] / d[2]];
        let [u, v] = [slope[0].abs(), slope[1].abs()];
        let steepest = if u > v { u } else { v };
        let change = bend + steepest * tilt;
        if starts && change < MET_ONCE && steepest < STEEPEST_START {
            return Verdict::Missed;
        }
        if !(change < NEARLY_LINEAR) {
            return Verdict::Uncertain;
        }
        let place = [0.5 + o[0] - o[2] * slope[0], 0.5 + o[1] - o[2] * slope[1]];
        if any && enter[2] > range.min && leave[2] < range.max {
            // With `E` for what the map differs from the linear one, a hit is an `x` with `x = place - E(x)`. There is one (Banach) if all
            // these `x` are within the piece, and `E` is at most `margin`: points are beside their parameters by `off` and beside the
            // plane by the height.
            let off = (side - 0.5) + bend;
            let margin = off + steepest * height + WELL_WITHIN;
            if place.iter().all(|x| *x > margin && *x < 1.0 - margin) {
                return Verdict::Met;
            }
        }
        Verdict::Certain(place)
    }
}

/// A matrix, given by its columns, times a vector with each coordinate in all lanes.
#[inline(always)]
fn product<I: Isa>(isa: I, columns: &[I::F64x4; 3], v: &[I::F64x4; 3]) -> I::F64x4 {
    isa.add(
        isa.add(isa.mul(columns[0], v[0]), isa.mul(columns[1], v[1])),
        isa.mul(columns[2], v[2]),
    )
}

/// A ray in the coordinates of a tree, each of them in all lanes of a vector.
pub(super) struct LocalRay<I: Isa> {
    pub(super) origin: [I::F64x4; 3],
    pub(super) direction: [I::F64x4; 3],
    /// A bound of rounding errors, per coordinate of a frame.
    pub(super) noise: I::F64x4,
}
