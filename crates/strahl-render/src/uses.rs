//! What primitives refer to: shapes, meshes and instances, with their appearance.

use crate::appearance::{Appearance, Appearances};
use crate::light_sets::Lit;
use std::sync::Arc;
use strahl_geometry::{Primitive, Shape, TriangleMesh};
use strahl_math::{Aabb, Interval, Ray, Transform};

#[derive(Clone, Debug)]
pub(crate) struct ShapeUse {
    pub(crate) shape: Shape,
    pub(crate) transform: Option<Box<Transform>>,
    /// A box for which rays are tested before the shape.
    pub(crate) early_box: Option<Box<EarlyBox>>,
    /// Object and material; CSG trees have one per leaf.
    pub(crate) appearance: Appearances,
    /// Where its inside is, if that is not what the surface says.
    pub(crate) inside: Option<Box<Inside>>,
}

/// A box that rays have to meet before the test for a shape is worth its time.
#[derive(Clone, Debug)]
pub(crate) enum EarlyBox {
    /// Around the shape, in its own space.
    ///
    /// Rays that reach the shape have met the box around it in the space of the group. If the map turns the shape, a ray in three misses
    /// the smaller box along its own axes.
    Own(Aabb),
    /// Around the bounds through which an endless shape is seen, in the space of the group: a ray that meets it nowhere does not see the
    /// shape, and one that does may meet the shape anywhere.
    Bounds(Aabb),
}

impl ShapeUse {
    /// The box for which rays should be tested before a shape; the map is from its space to that of the group.
    pub(crate) fn early_box(shape: &Shape, map: Option<&Transform>) -> Option<Box<EarlyBox>> {
        let bounds = shape.bounds();
        let is_useful = |bounds: &Aabb| bounds.is_bounded() && !bounds.is_empty();
        match shape {
            Shape::Bounded(bounded) if !bounds.is_bounded() => {
                let around = bounded.seen_through();
                is_useful(&around).then(|| Box::new(EarlyBox::Bounds(around)))
            }
            _ => {
                let turned = shape.wants_box() && map.is_some_and(Transform::turns_boxes);
                (turned && is_useful(&bounds)).then(|| Box::new(EarlyBox::Own(bounds)))
            }
        }
    }

    /// Whether a ray in the space of the shape may meet it in the range.
    #[inline(always)]
    pub(crate) fn may_be_met(&self, ray: &Ray, range: Interval) -> bool {
        match self.early_box.as_deref() {
            Some(EarlyBox::Own(own)) => own.may_be_met(ray, range),
            // The shape itself asks its bounds.
            Some(EarlyBox::Bounds(_)) | None => true,
        }
    }
}

/// Where the inside of a solid is that is cut or inverted.
#[derive(Clone, Debug)]
pub(crate) struct Inside {
    /// The solid as it was before `clipped_by`, which cuts no more than the surface.
    pub(crate) solid: Shape,
    /// Where it counts: as in POV-Ray (measured) the inverse of something bounded fills no more than its box.
    pub(crate) limit: Aabb,
}

impl Inside {
    /// The same in another space.
    pub(crate) fn moved(&self, map: &Transform) -> Option<Self> {
        let limit = if self.limit.is_bounded() {
            map.bounds_to_world(&self.limit)
        } else {
            Aabb::EVERYTHING
        };
        let solid = self.solid.baked(map)?;
        Some(Self { solid, limit })
    }
}

#[derive(Clone, Debug)]
pub(crate) struct MeshUse {
    pub(crate) mesh: Arc<TriangleMesh>,
    pub(crate) appearance: Appearance,
}

#[derive(Clone, Debug)]
pub(crate) struct InstanceUse {
    pub(crate) group: u32,
    pub(crate) transform: Transform,
    /// How all its elements are lit; [`Lit::DEFAULT`] leaves it to the objects in the group.
    pub(crate) lit: Lit,
}
