use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::Sphere;

/// `sphere { centre, radius ... }`
pub(super) fn sphere(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let center = p.vector3()?;
        p.comma()?;
        let radius = p.float()?;
        // A sphere with a negative radius is the same sphere, in all versions.
        Ok(Sphere::try_new(center, radius.abs()))
    })
}
