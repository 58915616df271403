use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::Plane;
use strahl_math::DVec3;

/// `plane { normal, distance ... }`: the distance is measured along the unit normal.
pub(super) fn plane(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let token = p.peek()?;
        let place = p.place_of(token);
        let normal = p.vector3()?;
        if normal == DVec3::ZERO {
            return Err(p.fail(place, "the normal of the plane is zero"));
        }
        p.comma()?;
        let distance = p.float()?;
        let point = normal.normalize_or_zero() * distance;
        Ok(Plane::try_new(point, normal))
    })
}
