use strahl_math::{Aabb, DVec3};

/// The primitives `0..n` as builders see them: their boxes, and more exact geometry.
///
/// Only [`Shapes::bounds`] is required. The other methods make structures smaller and rays cheaper; if [`Shapes::overlaps`]
/// wrongly returned `false`, or a sphere were too small, hits would be lost.
pub trait Shapes: Sync {
    /// Number of primitives, at most 2³¹.
    fn count(&self) -> usize;

    /// The box around a primitive; empty if it can't be hit, unbounded if necessary.
    fn bounds(&self, id: u32) -> Aabb;

    /// The class of a primitive, from 0 to 3, for structures whose leaves have one class each (see [`Bvh8`](crate::Bvh8)).
    fn class(&self, _id: u32) -> u8 {
        0
    }

    /// Whether the surface of a bounded primitive may overlap a box that overlaps its own box: `false` only if it certainly
    /// does not. For boxes inside of a ball the answer may be `false` too, because rays hit surfaces.
    fn overlaps(&self, _id: u32, _cell: &Aabb) -> bool {
        true
    }

    /// Boxes around the lower and the upper side of a part of a bounded primitive, split by a plane across an axis; points in
    /// the plane belong to both. The part is that within the box `part`. An empty side has an empty box.
    ///
    /// Because of the rounding of f64 a hit may be further away from the boxes than from the primitive; culling allows for far
    /// more.
    fn halves(&self, _id: u32, part: &Aabb, axis: usize, at: f64) -> [Aabb; 2] {
        cut_box(part, axis, at)
    }

    /// Half the surface area of boxes around ever smaller parts of a flat primitive, summed up: if that is much less than that
    /// of its own box, splitting it pays. `None` for primitives that are not flat.
    fn flat_area(&self, _id: u32) -> Option<f64> {
        None
    }

    /// A sphere (centre and radius) around a bounded primitive that may be smaller than the one around its box.
    fn sphere(&self, _id: u32) -> Option<(DVec3, f64)> {
        None
    }
}

/// The parts of a box below and above a plane across an axis.
pub fn cut_box(part: &Aabb, axis: usize, at: f64) -> [Aabb; 2] {
    let (mut lower, mut upper) = (*part, *part);
    lower.max[axis] = at;
    upper.min[axis] = at;
    [lower, upper]
}

/// Primitives given by their boxes alone, which they are assumed to fill.
#[derive(Clone, Copy, Debug)]
pub struct Boxes<'b>(pub &'b [Aabb]);

impl Shapes for Boxes<'_> {
    fn count(&self) -> usize {
        self.0.len()
    }

    fn bounds(&self, id: u32) -> Aabb {
        self.0[id as usize]
    }
}

/// The same primitives without their exact geometry, for structures that only use boxes.
pub(crate) struct BoxesOnly<'s>(pub(crate) &'s dyn Shapes);

impl Shapes for BoxesOnly<'_> {
    fn count(&self) -> usize {
        self.0.count()
    }

    fn bounds(&self, id: u32) -> Aabb {
        self.0.bounds(id)
    }
}

/// All boxes.
pub(crate) fn all_bounds(shapes: &dyn Shapes) -> Vec<Aabb> {
    (0..shapes.count() as u32)
        .map(|id| shapes.bounds(id))
        .collect()
}
