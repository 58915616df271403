use crate::parser::{PResult, Parser};
use strahl_geometry::Cuboid;
use strahl_scene::Object;

/// `box { corner, corner ... }`
pub(super) fn cuboid(p: &mut Parser<'_>) -> PResult<Object> {
    p.shape(|p| {
        let a = p.vector3()?;
        p.comma()?;
        let b = p.vector3()?;
        let cuboid = Cuboid::from_corners(a, b);
        Ok(Cuboid::try_new(cuboid.min(), cuboid.max()))
    })
}
