use strahl_math::{Aabb, DVec3};

/// What the builders may ask about the primitives `0..n`: their boxes, and more exactly where they are.
///
/// Only [`Shapes::bounds`] must be known. The other answers make structures smaller and rays cheaper; a wrong `false` of
/// [`Shapes::overlaps`], or a sphere that is too small, would lose hits.
pub trait Shapes: Sync {
    /// Number of primitives, at most 2³¹.
    fn count(&self) -> usize;

    /// The box around a primitive; empty if it can't be hit, unbounded if need be.
    fn bounds(&self, id: u32) -> Aabb;

    /// The class of a primitive, from 0 to 3, for structures whose leaves have one class each (see [`Bvh8`](crate::Bvh8)).
    fn class(&self, _id: u32) -> u8 {
        0
    }

    /// Whether the surface of a bounded primitive may reach into a box that its own box reaches into: `false` only if it
    /// certainly does not. The insides of a ball may say `false` too: rays hit surfaces.
    fn overlaps(&self, _id: u32, _cell: &Aabb) -> bool {
        true
    }

    /// Of the part of a bounded primitive that is in a box: boxes around what is on the lower and on the upper side of a plane across an axis, both
    /// with what is in the plane. Empty where there is nothing.
    ///
    /// A point that is hit may be further away from them than from the primitive by the rounding of f64; culling allows for far more.
    fn halves(&self, _id: u32, part: &Aabb, axis: usize, at: f64) -> [Aabb; 2] {
        cut_box(part, axis, at)
    }

    /// Half the surface area, in total, of boxes around ever smaller parts of a flat primitive: where that is much less than that of its own box,
    /// it pays to cut it. `None` for others.
    fn flat_area(&self, _id: u32) -> Option<f64> {
        None
    }

    /// A sphere (centre and radius) around a bounded primitive that may be smaller than the one around its box.
    fn sphere(&self, _id: u32) -> Option<(DVec3, f64)> {
        None
    }
}

/// What is on the lower and on the upper side of a plane across an axis, of a box.
pub fn cut_box(part: &Aabb, axis: usize, at: f64) -> [Aabb; 2] {
    let (mut lower, mut upper) = (*part, *part);
    lower.max[axis] = at;
    upper.min[axis] = at;
    [lower, upper]
}

/// Boxes alone: primitives fill their boxes as far as anybody knows.
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

/// The same without the exact answers: what structures look like if boxes decide.
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
