use crate::{Object, ObjectKind};
use std::sync::Arc;
use strahl_geometry::{Nurbs, Primitive, Shape};
use strahl_math::Transform;

/// The NURBS surfaces that an object consists of, at their places: one surface, or a union of objects that are such surfaces.
///
/// # Errors
/// The kind of a part that is no NURBS surface, in words.
pub fn nurbs_faces(object: &Object) -> Result<Vec<Arc<Nurbs>>, &'static str> {
    let mut faces = vec![];
    let mut waiting = vec![(object, Transform::default())];
    while let Some((object, outer)) = waiting.pop() {
        let place = match &object.transform {
            Some(own) => own.then(&outer),
            None => outer,
        };
        match &object.kind {
            ObjectKind::Shape(Shape::Nurbs(face)) if place.is_identity() => {
                faces.push(Arc::clone(face));
            }
            ObjectKind::Shape(Shape::Nurbs(face)) => match face.baked(&place) {
                Some(Shape::Nurbs(face)) => faces.push(face),
                _ => return Err("a surface that its transformation makes too thin or too large"),
            },
            ObjectKind::Shape(shape) => return Err(shape.kind()),
            ObjectKind::Csg { op, children } if op.is_union() => {
                waiting.extend(children.0.iter().rev().map(|child| (child, place)));
            }
            ObjectKind::Csg { op, .. } => return Err(op.name()),
            ObjectKind::Instance(_) => return Err("an instance"),
            ObjectKind::Light(_) => return Err("a light"),
        }
    }
    Ok(faces)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CsgOp;
    use strahl_geometry::{NurbsData, Sphere};
    use strahl_math::DVec3;

    fn face() -> Object {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X + DVec3::Y];
        let surface = Nurbs::try_new(&NurbsData::new([1, 1], 2, points)).unwrap();
        Object::new(ObjectKind::Shape(surface.into()))
    }

    #[test]
    fn faces_are_at_their_places() {
        let mut moved = face();
        moved.transform = Some(Box::new(Transform::translate(DVec3::Z)));
        let mut both = Object::csg(CsgOp::Union, vec![face(), moved]);
        both.transform = Some(Box::new(Transform::translate(DVec3::Z * 2.0)));
        let faces = nurbs_faces(&both).unwrap();
        let heights: Vec<f64> = faces.iter().map(|face| face.bounds().center().z).collect();
        assert_eq!(heights, [2.0, 3.0]);
    }

    #[test]
    fn other_objects_are_named() {
        let ball = || Object::new(ObjectKind::Shape(Sphere::new(DVec3::ZERO, 1.0).into()));
        assert_eq!(nurbs_faces(&ball()).unwrap_err(), "sphere");
        let cut = Object::csg(CsgOp::Difference, vec![face(), ball()]);
        assert_eq!(nurbs_faces(&cut).unwrap_err(), "difference");
        assert_eq!(
            nurbs_faces(&Object::csg(CsgOp::Union, vec![]))
                .unwrap()
                .len(),
            0
        );
    }
}
