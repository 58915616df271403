use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::{Cuboid, Polygon, Shape};
use strahl_math::DVec3;

/// `box { corner, corner ... }`; without thickness along one axis it is a rectangle.
pub(super) fn cuboid(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let a = p.vector3()?;
        p.comma()?;
        let b = p.vector3()?;
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
