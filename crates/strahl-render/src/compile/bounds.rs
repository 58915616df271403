//! Bounds of objects that decide which rays see them (`CsgOp::Bound`).

use super::inside::{placed, solid};
use std::sync::Arc;
use strahl_geometry::{Bounded, Csg, Primitive, Shape, Solid};
use strahl_math::{DVec3, Transform};
use strahl_scene::{CsgOp, Object, ObjectKind};

/// One bound, in the space of the group.
#[derive(Clone, Debug)]
pub(super) struct Bound {
    solid: Arc<Csg>,
    /// Whether a box lies in it as soon as its corners do.
    convex: bool,
}

impl Bound {
    /// The bound that an object is; `to_group` is from its parent's space. `None` if it is no valid shape.
    pub(super) fn of(object: &Object, to_group: &Transform) -> Option<Self> {
        Some(Self {
            solid: Arc::new(solid(object, &placed(object, to_group))?),
            convex: is_convex(object),
        })
    }

    /// Whether the bound certainly surrounds an object as a whole; `to_group` is from the space of its parent.
    pub(super) fn surrounds_object(&self, object: &Object, to_group: &Transform) -> bool {
        self.convex
            && is_small(object)
            && solid(object, &placed(object, to_group))
                .is_some_and(|tree| tree.lies_within(&self.solid))
    }

    /// Whether a shape certainly lies within the bound, nowhere near its surface; `to_group` is from the shape's own space.
    pub(super) fn holds(&self, shape: &Shape, to_group: &Transform) -> bool {
        /// Far above rounding errors, relative to the size and to the coordinates of the shape.
        const NEAR: f64 = 1e-6;
        if !self.convex {
            return false;
        }
        let bounds = to_group.bounds_to_world(&shape.bounds());
        let near = DVec3::splat(NEAR * (bounds.size().max_element() + bounds.max_abs()));
        bounds.is_bounded()
            && (bounds.padded(near).corners().into_iter()).all(|corner| self.solid.contains(corner))
    }

    /// Whether the bound certainly surrounds a shape.
    fn surrounds(&self, shape: &Shape, to_group: &Transform) -> bool {
        let bounds = match shape.as_solid() {
            Some(solid) => solid.inside_bounds().union(&shape.bounds()),
            None => shape.bounds(),
        };
        let is_within = |corner| self.solid.contains(to_group.point_to_world(corner));
        self.convex && bounds.is_bounded() && bounds.corners().into_iter().all(is_within)
    }
}

/// A shape as it is seen through all these bounds; `to_group` is from its own space.
pub(super) fn bounded(shape: &Shape, bounds: &[Bound], to_group: &Transform) -> Option<Shape> {
    let deciding = bounds.iter().filter(|b| !b.surrounds(shape, to_group));
    let solids: Vec<Arc<Csg>> = deciding.map(|b| Arc::clone(&b.solid)).collect();
    let map = (!to_group.is_identity()).then(|| to_group.inverted());
    (!solids.is_empty()).then(|| Bounded::new(shape.clone(), solids, map).into())
}

/// Whether an object has so few parts that its tree can be made once more.
fn is_small(object: &Object) -> bool {
    const PARTS: usize = 64;
    let mut parts = vec![object];
    let mut next = 0;
    while let Some(object) = parts.get(next) {
        if let ObjectKind::Csg { children, .. } = &object.kind {
            parts.extend(&children.0);
        }
        if parts.len() > PARTS {
            return false;
        }
        next += 1;
    }
    true
}

fn is_convex(object: &Object) -> bool {
    let mut waiting = vec![object];
    while let Some(object) = waiting.pop() {
        match &object.kind {
            ObjectKind::Shape(
                Shape::Sphere(_)
                | Shape::Cuboid(_)
                | Shape::Cylinder(_)
                | Shape::Cone(_)
                | Shape::Plane(_),
            ) => {}
            ObjectKind::Csg {
                op: CsgOp::Intersection,
                children,
            } => waiting.extend(&children.0),
            _ => return false,
        }
    }
    true
}
