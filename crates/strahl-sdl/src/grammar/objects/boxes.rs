use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::{Cuboid, GeometryError, Shape};
use strahl_math::DVec3;

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
