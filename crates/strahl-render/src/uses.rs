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
    /// The box around the shape in its own space, where it tells rays apart that the box in the group's space does not.
    pub(crate) own_box: Option<Box<Aabb>>,
    /// Object and material; CSG trees have one per leaf.
    pub(crate) appearance: Appearances,
    /// Where its inside is, if that is not what the surface says.
    pub(crate) inside: Option<Box<Inside>>,
}

impl ShapeUse {
    /// The box around a shape in its own space, if rays should be tested for it before they are for the shape.
    ///
    /// Rays that reach the shape have met the box around it in the space of the group. If the map turns the shape, a ray in three misses the
    /// smaller box along its own axes.
    pub(crate) fn own_box(shape: &Shape, map: &Transform) -> Option<Box<Aabb>> {
        if !(shape.wants_box() && map.turns_boxes()) {
            return None;
        }
        let bounds = shape.bounds();
        (bounds.is_bounded() && !bounds.is_empty()).then(|| Box::new(bounds))
    }

    /// Whether a ray in the space of the shape may meet it in the range.
    #[inline(always)]
    pub(crate) fn may_be_met(&self, ray: &Ray, range: Interval) -> bool {
        self.own_box
            .as_ref()
            .is_none_or(|own| own.may_be_met(ray, range))
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
