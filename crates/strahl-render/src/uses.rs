//! What primitives refer to: shapes, meshes and instances, with their appearance.

use crate::appearance::{Appearance, Appearances};
use crate::light_sets::Lit;
use std::sync::Arc;
use strahl_geometry::{Primitive, Shape, TriangleMesh};
use strahl_math::{Aabb, Transform};

#[derive(Clone, Debug)]
pub(crate) struct ShapeUse {
    pub(crate) shape: Shape,
    pub(crate) transform: Option<Box<Transform>>,
    /// Object and material; CSG trees have one per leaf.
    pub(crate) appearance: Appearances,
    /// Where its inside is, if that is not what the surface says.
    pub(crate) inside: Option<Box<Inside>>,
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
