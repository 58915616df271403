//! `bounded_by`: what of its bounds POV-Ray keeps.
//!
//! Measured: rays that miss a bound don't see the object. Operations, texts and polynomials keep bounds that are not unbounded themselves.
//! Other objects have the box around the bounds instead, if it is smaller than the box around the object. Those that are found
//! quickly, such as spheres and meshes, have no bounds. An intersection is seen only through the boxes of its bounded parts, a
//! difference through that of its first part.

use super::extents::{extent, extent_within, is_smaller};
use super::reuse::Shared;
use strahl_geometry::{Cuboid, Primitive, Shape};
use strahl_math::{Aabb, DVec3, Transform};
use strahl_scene::{CsgOp, Object, ObjectKind};

/// How bounds act on an object.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Keeps {
    Nothing,
    Box,
    Bounds,
}

/// The bounds that decide which rays see an object, of those given to it.
pub(super) fn deciding(object: &Object, given: Vec<Object>, shared: &Shared) -> Vec<Object> {
    let keeps = keeps(object, shared);
    if given.is_empty() || keeps == Keeps::Nothing {
        return vec![];
    }
    let mut around = given.iter().fold(Aabb::EVERYTHING, |all, bound| {
        all.intersection(&extent(bound, shared))
    });
    let own = extent_within(object, CsgOp::Bound, shared);
    match keeps {
        Keeps::Bounds if !around.is_bounded() => vec![],
        Keeps::Bounds if given.iter().all(|bound| surrounds(bound, &own)) => vec![],
        Keeps::Bounds => given,
        Keeps::Nothing | Keeps::Box => {
            if is_bound(object) {
                around = around.intersection(&extent(object, shared));
            }
            let bounds = is_smaller(&around, &own)
                .then(|| Object::from(Cuboid::new(around.min, around.max)));
            bounds.into_iter().collect()
        }
    }
}

/// The box that an operation is seen through because of the bounds of its parts.
pub(super) fn narrowed(op: CsgOp, parts: &[Object], shared: &Shared) -> Option<Object> {
    let deciding = match op {
        CsgOp::Intersection => parts,
        CsgOp::Difference => parts.get(..1)?,
        _ => return None,
    };
    let around = deciding
        .iter()
        .filter(|part| is_bound(part))
        .map(|part| extent(part, shared))
        .reduce(|a, b| a.intersection(&b))?;
    around
        .is_bounded()
        .then(|| Cuboid::new(around.min, around.max).into())
}

fn is_bound(object: &Object) -> bool {
    let op = CsgOp::Bound;
    matches!(&object.kind, ObjectKind::Csg { op: found, .. } if *found == op)
}

/// How bounds act on objects of this kind.
fn keeps(object: &Object, shared: &Shared) -> Keeps {
    let mut kind = &object.kind;
    loop {
        match kind {
            ObjectKind::Instance(id) => match shared.kind_of(*id) {
                Some(declared) => kind = &declared.kind,
                None => return Keeps::Nothing,
            },
            ObjectKind::Csg {
                op: CsgOp::Clip | CsgOp::Bound | CsgOp::Inverse,
                children,
            } => match children.0.first() {
                Some(inner) => kind = &inner.kind,
                None => return Keeps::Nothing,
            },
            // The parts of a mesh, if their textures differ.
            ObjectKind::Csg { children, .. }
                if children.0.iter().all(|part| is_mesh(&part.kind)) =>
            {
                return Keeps::Nothing;
            }
            ObjectKind::Csg { .. } | ObjectKind::Shape(Shape::Glyph(_) | Shape::Polynomial(_)) => {
                return Keeps::Bounds;
            }
            ObjectKind::Light(_) => return Keeps::Nothing,
            ObjectKind::Shape(
                Shape::Sphere(_)
                | Shape::Cuboid(_)
                | Shape::Plane(_)
                | Shape::Triangle(_)
                | Shape::SmoothTriangle(_)
                | Shape::HeightField(_)
                | Shape::Blob(_)
                | Shape::Julia(_),
            ) => return Keeps::Nothing,
            kind if is_mesh(kind) => return Keeps::Nothing,
            ObjectKind::Shape(_) => return Keeps::Box,
        }
    }
}

fn is_mesh(kind: &ObjectKind) -> bool {
    matches!(
        kind,
        ObjectKind::Shape(Shape::TriangleMesh(_) | Shape::Brep(_))
    )
}

/// Whether a bound certainly contains a box.
fn surrounds(bound: &Object, bounds: &Aabb) -> bool {
    let ObjectKind::Shape(
        shape @ (Shape::Sphere(_)
        | Shape::Cuboid(_)
        | Shape::Cylinder(_)
        | Shape::Cone(_)
        | Shape::Plane(_)),
    ) = &bound.kind
    else {
        return false;
    };
    let map = bound.transform.as_deref();
    let own = |corner: DVec3| map.map_or(corner, |map: &Transform| map.point_to_object(corner));
    let Some(solid) = shape.as_solid() else {
        return false;
    };
    bounds.is_bounded() && bounds.corners().into_iter().all(|c| solid.contains(own(c)))
}
