use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::{Cuboid, GeometryError, Shape};
use strahl_math::DVec3;

/// The thickness of a box that is flat along one axis, relative to its size and place.
const THIN: f64 = 8.0 * f64::EPSILON;

/// What stands for an infinite coordinate of a corner: farther than anything can be seen, and its square is still a number.
const FAR: f64 = 1e100;

/// A corner with numbers in place of infinities.
fn finite(corner: DVec3) -> DVec3 {
    DVec3::from_array(corner.to_array().map(|x| match x {
        _ if x.is_nan() => x,
        x => x.clamp(-FAR, FAR),
    }))
}

/// `box { corner, corner ... }`; without thickness along one axis it is a rectangle.
///
/// As in POV-Ray, a box goes on for ever where a coordinate of one corner is infinite, and cannot be seen if those of both are.
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
            // A box without thickness is visible, but nothing is inside of it.
            let (mut min, max) = (cuboid.min(), cuboid.max());
            let size = min.abs().max_element() + (max - min).max_element();
            min[axis] -= THIN * size;
            cuboid = Cuboid::from_corners(min, max);
        }
        Ok(Cuboid::try_new(cuboid.min(), cuboid.max()).map(Shape::from))
    })
}
