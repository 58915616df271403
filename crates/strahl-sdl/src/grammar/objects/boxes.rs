use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::{Cuboid, GeometryError, Shape};
use strahl_math::{DMat3, DVec3, Transform};
use strahl_scene::{Object, ObjectKind};

/// The thickness of a box that is flat along one axis, relative to its size and place.
const THIN: f64 = 8.0 * f64::EPSILON;

/// Replaces an infinite coordinate of a corner: farther away than any visible point, and its square is still finite.
const FAR: f64 = 1e100;

/// A corner with infinite coordinates replaced.
fn finite(corner: DVec3) -> DVec3 {
    DVec3::from_array(corner.to_array().map(|x| match x {
        _ if x.is_nan() => x,
        x => x.clamp(-FAR, FAR),
    }))
}

/// `box { corner, corner ... }`; a box with no extent along one axis is a rectangle.
///
/// As in POV-Ray, a box extends infinitely where one corner has an infinite coordinate; it is invisible if both corners do.
pub(super) fn cuboid(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let a = p.vector3()?;
        p.comma()?;
        let b = p.vector3()?;
        let endless = |i: usize| a[i].is_infinite() && b[i].is_infinite();
        if (0..3).any(endless) {
            return Ok(Err(GeometryError::Degenerate {
                what: "box",
                why: "both corners are infinitely far away along the same axis",
            }));
        }
        let (a, b) = (finite(a), finite(b));
        let flat = [a.x == b.x, a.y == b.y, a.z == b.z];
        let mut cuboid = Cuboid::from_corners(a, b);
        if let Some(axis) = (0..3)
            .find(|&i| flat[i])
            .filter(|_| flat.iter().filter(|f| **f).count() == 1)
        {
            // A box with no thickness is visible, but has no inside.
            let (mut min, max) = (cuboid.min(), cuboid.max());
            let size = min.abs().max_element() + (max - min).max_element();
            min[axis] -= THIN * size;
            cuboid = Cuboid::from_corners(min, max);
        }
        Ok(Cuboid::try_new(cuboid.min(), cuboid.max()).map(Shape::from))
    })
}

impl Parser<'_> {
    /// Keeps the texture coordinates of boxes in an object from being mirrored by a `scale` that follows.
    ///
    /// As in POV-Ray (measured) `scale` and `translate` move the corners of a box until it is transformed in another way, so one that is
    /// mirrored shows its texture as every other box.
    ///
    /// # Errors
    /// If there are too many parts.
    pub(super) fn scale_boxes(&mut self, object: &mut Object, scale: &Transform) -> PResult<()> {
        let mirrored = scale.linear().to_cols_array_2d();
        let mirrored = std::array::from_fn(|axis| mirrored[axis][axis] < 0.0);
        if mirrored == [false; 3] {
            return Ok(());
        }
        self.expand_mapped_boxes(object)?;
        let mut waiting = vec![object];
        while let Some(object) = waiting.pop() {
            let linear = object.transform.as_ref().map(|map| map.linear());
            if linear.is_some_and(|m| m != DMat3::from_diagonal(m.diagonal())) {
                continue;
            }
            match &mut object.kind {
                ObjectKind::Shape(Shape::Cuboid(cuboid)) => {
                    *cuboid = cuboid.with_mirrored_texture(mirrored);
                }
                ObjectKind::Csg { children, .. } => waiting.extend(&mut children.0),
                ObjectKind::Shape(_) | ObjectKind::Instance(_) | ObjectKind::Light(_) => {}
            }
        }
        Ok(())
    }
}
