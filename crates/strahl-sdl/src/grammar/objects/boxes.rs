use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::{Cuboid, GeometryError, Polygon, Shape};
use strahl_math::DVec3;

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
        let corner = |x: bool, y: bool, z: bool| {
            let pick = |second, a, b| if second { b } else { a };
            DVec3::new(pick(x, a.x, b.x), pick(y, a.y, b.y), pick(z, a.z, b.z))
        };
        let ring = [(false, false), (true, false), (true, true), (false, true)];
        let rectangle = match flat {
            [true, false, false] => Some(ring.map(|(s, t)| corner(false, s, t))),
            [false, true, false] => Some(ring.map(|(s, t)| corner(t, false, s))),
            [false, false, true] => Some(ring.map(|(s, t)| corner(s, t, false))),
            _ => None,
        };
        Ok(match rectangle {
            Some(corners) => Polygon::try_new(&corners).map(Shape::from),
            None => {
                let cuboid = Cuboid::from_corners(a, b);
                Cuboid::try_new(cuboid.min(), cuboid.max()).map(Shape::from)
            }
        })
    })
}
