//! Sixteen boxes tested at once: for shapes with a tree of their own, whose parts are no primitives of the scene.

use crate::boxes::Box32;
use crate::cull::{CullBounds, CullClock, QuickLanes};
use strahl_math::{Aabb, DVec3, Interval, Ray};
use strahl_simd::{Isa, Lanes16};

/// How far the boxes of a [`SixteenBoxes`] may reach from the origin along every axis.
pub const SIXTEEN_REACH: f64 = 2.0;

/// Rays may start so far away without being moved: so far f32 has the boxes exact to a ten-thousandth of what they are in.
const NEAR: f32 = 256.0;

/// Sixteen boxes within [`SIXTEEN_REACH`] of the origin, in f32, rounded outwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SixteenBoxes {
    /// Per axis the lower planes, then the upper planes.
    planes: [Lanes16; 6],
}

impl SixteenBoxes {
    /// Boxes that no ray meets.
    pub const EMPTY: Self = {
        let (low, high) = (
            Lanes16([f32::INFINITY; 16]),
            Lanes16([f32::NEG_INFINITY; 16]),
        );
        Self {
            planes: [low, high, low, high, low, high],
        }
    };

    /// Sets the box of a place from 0 to 15. What is beyond the reach is cut off.
    pub fn set(&mut self, place: usize, bounds: &Aabb) {
        let reach = DVec3::splat(SIXTEEN_REACH);
        let cut = Aabb::new(bounds.min.max(-reach), bounds.max.min(reach));
        let rounded = Box32::around(&cut);
        for axis in 0..3 {
            self.planes[2 * axis].0[place] = rounded.lo()[axis];
            self.planes[2 * axis + 1].0[place] = rounded.hi()[axis];
        }
    }
}

/// A ray for testing [`SixteenBoxes`], with the culling test of the accelerators: it may be told that it meets a box which it misses,
/// by rounding, but never the other way around.
pub struct SixteenSlabs<I: Isa> {
    rd: [I::F32x16; 3],
    minus_near: [I::F32x16; 3],
    minus_far: [I::F32x16; 3],
    /// Per axis which of the two planes the ray crosses first.
    first: [usize; 3],
    t_min: I::F32x16,
    clock: CullClock,
}

impl<I: Isa> SixteenSlabs<I> {
    /// `None` if the ray certainly misses everything within the reach in this range.
    #[inline(always)]
    pub fn new(isa: I, ray: &Ray, range: Interval) -> Option<Self> {
        let structure = CullBounds::of_unit(SIXTEEN_REACH, NEAR);
        let lanes = QuickLanes::new(isa, ray, range, &structure)?;
        let (rd, near, far) = (
            isa.store_f32(lanes.rd).0,
            isa.store_f32(lanes.minus_near).0,
            isa.store_f32(lanes.minus_far).0,
        );
        let down = lanes.down as usize;
        let clock = lanes.clock;
        Some(Self {
            rd: splats(isa, rd),
            minus_near: splats(isa, near),
            minus_far: splats(isa, far),
            first: [down & 1, down >> 1 & 1, down >> 2 & 1],
            t_min: isa.splat_f32x16(clock.t_min(range.min)),
            clock,
        })
    }

    /// An upper end of the range, for [`SixteenSlabs::enter`].
    #[inline(always)]
    pub fn t_max(&self, t_max: f64) -> f32 {
        self.clock.t_max(t_max)
    }

    /// Where the ray enters the boxes, in units that can be compared with each other and with what [`SixteenSlabs::t_max`] gives,
    /// and the boxes that it may meet before `t_max`, as bits.
    #[inline(always)]
    pub fn enter(&self, isa: I, boxes: &SixteenBoxes, t_max: f32) -> (I::F32x16, u32) {
        let planes = |axis: usize, side: usize| isa.load_f32x16(&boxes.planes[2 * axis + side]);
        let (mut enter, mut leave) = (self.t_min, isa.splat_f32x16(t_max));
        for axis in 0..3 {
            let first = self.first[axis];
            let near =
                isa.mul_add_f32x16(planes(axis, first), self.rd[axis], self.minus_near[axis]);
            let far =
                isa.mul_add_f32x16(planes(axis, 1 - first), self.rd[axis], self.minus_far[axis]);
            enter = isa.max_bits_x16(enter, near);
            leave = isa.min_bits_x16(leave, far);
        }
        (enter, isa.le_f32x16(enter, leave))
    }
}

/// The first three numbers, each in a vector of its own.
#[inline(always)]
fn splats<I: Isa>(isa: I, [x, y, z, ..]: [f32; 8]) -> [I::F32x16; 3] {
    [
        isa.splat_f32x16(x),
        isa.splat_f32x16(y),
        isa.splat_f32x16(z),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_simd::{Simd, dispatch};

    #[test]
    fn no_box_is_lost_and_most_that_are_missed_are_left_out() {
        let mut seed = 3_u64;
        let mut signed = move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        let (mut met, mut missed, mut wrongly) = (0, 0, 0);
        for round in 0..4000 {
            let mut boxes = SixteenBoxes::EMPTY;
            let mut exact = vec![];
            for place in 0..15 {
                let a = DVec3::new(signed(), signed(), signed());
                let b = a + DVec3::new(signed(), signed(), signed()) * 0.1;
                let one = Aabb::from_points([a, b]);
                boxes.set(place, &one);
                exact.push(one);
            }
            let distance = [1.0, 5.0, 200.0, 1e7][round % 4];
            let origin = DVec3::new(signed(), signed(), signed()) * distance;
            // Towards a box, nearly.
            let aim = exact[round % 15];
            let aside = DVec3::new(signed(), signed(), signed());
            let mut direction = aim.center() + aim.size() * aside - origin;
            if round % 5 == 0 {
                direction.y = 0.0;
            }
            let ray = Ray::new(origin, direction.normalize());
            let range = [
                Interval::FORWARD,
                Interval::new(0.2 * distance, 2.0 * distance),
            ][round % 2];
            for simd in Simd::available() {
                let hit = dispatch!(simd, isa => {
                    SixteenSlabs::new(isa, &ray, range).map_or(0, |slabs| {
                        let t_max = slabs.t_max(range.max);
                        slabs.enter(isa, &boxes, t_max).1
                    })
                });
                assert_eq!(hit >> 15, 0, "there is no box at the last place");
                for (place, one) in exact.iter().enumerate() {
                    let is_met = one.clip(&ray, range).is_some();
                    let found = hit >> place & 1 == 1;
                    assert!(found || !is_met, "{simd:?} {ray:?} {one:?}");
                    met += usize::from(is_met);
                    missed += usize::from(!is_met);
                    wrongly += usize::from(found && !is_met);
                }
            }
        }
        assert!(
            met > 2000 && wrongly < missed / 100,
            "{met} {missed} {wrongly}"
        );
    }
}
