//! The walk of a ray through cells, for grids and octrees.
//!
//! # Why no hit is lost
//! A walk is a sequence of cells with the parameters at which the ray passes from one to the next. Planes are f64 and every
//! crossing is computed from its plane (nothing is accumulated). So at any t in the interval that the walk gives for a cell,
//! the point of the ray is at most a few ε(B + |o|) outside of the cell: ε = 2⁻⁵³, B the largest coordinate, |o| <= 4B (see
//! [`Moved`]). Primitives are entered into every cell that they, or hits up to 8u(B + |o|) beside them (u = 2⁻²⁴), may reach
//! into: cells are padded by 48uB for this test, which covers both. Hence a primitive hit at t is in the cell that the walk
//! gives for t, and the walk may end as soon as the closest hit is before the next crossing, but not if it is exactly there.
//!
//! Rays that start so far away that their own rounding exceeds the pad visit all cells within their margin instead
//! ([`Walk::is_thick`]).

use crate::cull::CullBounds;
use crate::moved::{FAR, Moved, SLACK};
use strahl_math::{Aabb, DVec3, Interval, Ray};

/// Cells are padded by this times B when primitives are entered.
const PAD: f64 = SLACK * (1.0 + FAR + 1.0);

/// The box whose cells are walked through, and its pad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Room {
    /// The box around all primitives, enlarged by the pad.
    pub(crate) root: Aabb,
    /// The pad of cells when primitives are entered.
    pub(crate) pad: f64,
    bounds: CullBounds,
}

impl Room {
    /// The room of primitives that all lie in a bounded box.
    pub(crate) fn new(bounds: Aabb) -> Self {
        let cull = CullBounds::new(bounds);
        let pad = PAD * cull.max_abs();
        Self {
            root: bounds.padded(DVec3::splat(2.0 * pad)),
            pad,
            bounds: cull,
        }
    }

    /// The same, larger by a thousandth on every side: so V. Havran's seems to be, because no plane of its cells coincides with
    /// the planes of `tetra`. See docs/src/laboratory.md.
    pub(crate) fn published(bounds: Aabb) -> Self {
        Self::new(bounds.padded(bounds.size() * 1e-3))
    }

    /// Smaller cells would consist of little but their pads.
    pub(crate) fn smallest_cell(&self) -> f64 {
        8.0 * self.pad
    }
}

/// A ray on its way through a room.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walk {
    pub(crate) moved: Moved,
    /// 1/d; 0 along axes the ray is parallel to.
    inverse: [f64; 3],
    /// -o/d; infinite along axes the ray is parallel to.
    start: [f64; 3],
    /// Where the ray enters the room.
    pub(crate) near: f64,
}

/// Components of a direction below this part of the largest count as zero: while it crosses the room, the ray moves by less
/// than 2⁻⁵⁷(B + |o|) along them.
const PARALLEL: f64 = 1.0 / (1u64 << 60) as f64;

impl Walk {
    /// The walk of a ray, or `None` if it misses the room.
    #[inline(always)]
    pub(crate) fn new(ray: &Ray, range: Interval, room: &Room) -> Option<Self> {
        let mut moved = Moved::new(ray, range, &room.bounds)?;
        let (mut inverse, mut start) = ([0.0; 3], [f64::INFINITY; 3]);
        for axis in 0..3 {
            let d = &mut moved.direction[axis];
            if d.abs() < PARALLEL {
                *d = 0.0;
            } else {
                inverse[axis] = 1.0 / *d;
                start[axis] = -(moved.origin[axis] * inverse[axis]);
            }
        }
        let root = match moved.margin > 0.0 {
            true => room.root.padded(DVec3::splat(moved.margin)),
            false => room.root,
        };
        let inside = root.clip(&Ray::new(moved.origin, moved.direction), moved.range)?;
        Some(Self {
            moved,
            inverse,
            start,
            near: inside.min,
        })
    }

    /// Whether the ray's own rounding error exceeds the pad of cells.
    pub(crate) fn is_thick(&self, room: &Room) -> bool {
        self.moved.margin > room.pad / 8.0
    }

    /// The parameter at which a thick ray enters a cell, if it may meet it before `far`.
    pub(crate) fn meets(&self, cell: &Aabb, far: f64) -> Option<f64> {
        let padded = cell.padded(DVec3::splat(self.moved.margin));
        let ray = Ray::new(self.moved.origin, self.moved.direction);
        let range = Interval::new(self.near, far);
        padded.clip(&ray, range).map(|inside| inside.min)
    }

    /// Where the ray crosses the plane of an axis; never (infinite) if it is parallel to it.
    #[inline(always)]
    pub(crate) fn cross(&self, axis: usize, plane: f64) -> f64 {
        plane * self.inverse[axis] + self.start[axis]
    }

    /// Whether the ray moves towards larger coordinates; also true if it does not move.
    #[inline(always)]
    pub(crate) fn up(&self, axis: usize) -> bool {
        self.moved.direction[axis] >= 0.0
    }

    /// A point of the ray, kept within a box.
    #[inline(always)]
    pub(crate) fn at_within(&self, t: f64, b: &Aabb) -> DVec3 {
        let mut p = self.moved.at(t);
        for axis in 0..3 {
            p[axis] = clamp(p[axis], b.min[axis], b.max[axis]);
        }
        p
    }

    /// A parameter of the ray as the visitor counts it.
    pub(crate) fn original(&self, t: f64) -> f64 {
        self.moved.original(t)
    }
}

/// The nearest number in a range; the lower end for NaN.
#[inline(always)]
pub(crate) fn clamp(x: f64, min: f64, max: f64) -> f64 {
    if x > max {
        max
    } else if x > min {
        x
    } else {
        min
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parallel_ray_crosses_no_plane() {
        let room = Room::new(Aabb::new(DVec3::ZERO, DVec3::ONE));
        let ray = Ray::new(DVec3::new(0.0, 0.5, -1.0), DVec3::new(0.0, -0.0, 2.0));
        let walk = Walk::new(&ray, Interval::FORWARD, &room).expect("through the room");
        assert_eq!(walk.cross(0, 0.0), f64::INFINITY);
        assert_eq!(walk.cross(1, -5.0), f64::INFINITY);
        assert!((walk.original(walk.cross(2, 1.0)) - 1.0).abs() < 1e-12);
        assert!(walk.original(walk.near) <= 0.5);
    }
}
