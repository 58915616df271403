use crate::parser::{PResult, Parser};
use strahl_geometry::Plane;
use strahl_scene::Object;

/// `plane { normal, distance ... }`: the distance is measured along the unit normal.
pub(super) fn plane(p: &mut Parser<'_>) -> PResult<Object> {
    p.shape(|p| {
        let normal = p.vector3()?;
        p.comma()?;
        let distance = p.float()?;
        let point = normal.normalize_or_zero() * distance;
        Ok(Plane::try_new(point, normal))
    })
}
