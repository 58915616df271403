//! Where the insides of solids are that are cut or inverted.

use super::operation::combine;
use crate::uses::Inside;
use std::sync::Arc;
use strahl_geometry::{Csg, CsgNode, Cuboid, Plane, Primitive, Shape, Solid};
use strahl_math::{Aabb, DVec3, Transform};
use strahl_scene::{CsgOp, Object, ObjectKind};

/// The inside of an object that is cut or inverted as a whole, or has a disc as a part; `to_group` is from its own space to that of its group. As in POV-Ray
/// (measured) `clipped_by` cuts the surface and not the inside, and neither reaches beyond the boxes of what takes part.
pub(super) fn of(object: &Object, to_group: &Transform) -> Option<Inside> {
    let (mut inner, mut inverted) = (object, false);
    let mut map = *to_group;
    let mut limit = Aabb::EVERYTHING;
    while let ObjectKind::Csg {
        op: op @ (CsgOp::Clip | CsgOp::Inverse),
        children,
    } = &inner.kind
    {
        let (first, others) = children.0.split_first()?;
        inverted ^= *op == CsgOp::Inverse;
        for other in others {
            limit = limit.intersection(&bounds(other, &placed(other, &map))?);
        }
        map = placed(first, &map);
        inner = first;
    }
    if std::ptr::eq(inner, object) && !has_disc(inner) {
        return None;
    }
    let own = solid(inner, &map)?;
    limit = limit.intersection(&bounds(inner, &map)?);
    let own = if inverted {
        let node = CsgNode::leaf(Arc::new(own), 0).inverted();
        Csg::try_new(node).ok()?
    } else {
        own
    };
    Some(Inside {
        solid: Arc::new(own).into(),
        limit,
    })
}

/// The box that POV-Ray has around something bounded; that of half-spaces and the like bounds nothing.
fn bounds(object: &Object, to_group: &Transform) -> Option<Aabb> {
    let bounds = combined(object, to_group, &boxed)?.inside_bounds();
    Some(if bounds.is_bounded() {
        bounds
    } else {
        Aabb::EVERYTHING
    })
}

/// Whether an object or a part of it is a disc.
fn has_disc(object: &Object) -> bool {
    let mut waiting = vec![object];
    while let Some(object) = waiting.pop() {
        match &object.kind {
            ObjectKind::Csg { children, .. } => waiting.extend(&children.0),
            ObjectKind::Shape(Shape::Disc(_)) => return true,
            _ => {}
        }
    }
    false
}

/// Something with the box of a shape, if the shape as a solid has another in strahl (measured): discs end with their surface, and so do
/// height fields but for those in an intersection; quadrics that are written with mixed terms have none.
fn boxed(shape: &Shape, parent: Option<CsgOp>) -> Shape {
    let cuboid = |bounds: Aabb| {
        // A flat one has no volume.
        let bounds = bounds.padded(DVec3::splat(1e-9));
        Cuboid::try_new(bounds.min, bounds.max).map_or_else(|_| shape.clone(), Shape::from)
    };
    // No box of another operand can be cut at it.
    let boundless = || Plane::new(DVec3::ZERO, DVec3::ONE).into();
    match shape {
        Shape::HeightField(field) => match parent {
            Some(CsgOp::Intersection | CsgOp::Difference) => boundless(),
            _ => cuboid(field.bounds()),
        },
        Shape::Disc(disc) => cuboid(disc.bounds()),
        Shape::Quadric(quadric) if quadric.has_mixed_terms() => boundless(),
        _ => shape.clone(),
    }
}

/// From an object's own space to that of its group, given the same for what it is a part of.
pub(super) fn placed(object: &Object, outer: &Transform) -> Transform {
    match object.transform.as_deref() {
        None => *outer,
        Some(own) => own.then(outer),
    }
}

/// The tree of an object by itself; `to_group` is from its own space. Walked with a list, since trees may be deeper than the stack.
pub(super) fn solid(object: &Object, to_group: &Transform) -> Option<Csg> {
    combined(object, to_group, &|shape, _| shape.clone())
}

/// The same with other shapes in their places, which may depend on the operation that they are operands of.
fn combined(
    object: &Object,
    to_group: &Transform,
    shape: &dyn Fn(&Shape, Option<CsgOp>) -> Shape,
) -> Option<Csg> {
    enum Step<'a> {
        Visit(&'a Object, Transform, Option<CsgOp>),
        Build(CsgOp, usize),
    }
    let mut steps = vec![Step::Visit(object, *to_group, None)];
    let mut done: Vec<CsgNode> = vec![];
    while let Some(step) = steps.pop() {
        let node = match step {
            Step::Build(op, count) => combine(op, done.split_off(done.len() - count)),
            Step::Visit(object, map, parent) => match &object.kind {
                ObjectKind::Csg { op, children } => {
                    let is_light = |c: &&Object| matches!(c.kind, ObjectKind::Light(_));
                    let parts = || children.0.iter().filter(|c| !is_light(c));
                    steps.push(Step::Build(*op, parts().count()));
                    let parts = parts().rev();
                    steps
                        .extend(parts.map(|part| Step::Visit(part, placed(part, &map), Some(*op))));
                    continue;
                }
                ObjectKind::Shape(own) => CsgNode::leaf(shape(own, parent), 0).transformed(map),
                ObjectKind::Instance(_) | ObjectKind::Light(_) => return None,
            },
        };
        done.push(node);
    }
    Csg::try_new(done.pop()?).ok()
}
