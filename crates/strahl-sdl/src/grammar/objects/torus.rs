use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::Torus;
use strahl_math::DVec3;

/// `torus { major radius, minor radius ... }` about the y axis
pub(super) fn torus(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let major = p.float()?;
        p.comma()?;
        let minor = p.float()?;
        Ok(Torus::try_new(DVec3::ZERO, DVec3::Y, major, minor))
    })
}
