use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::Superellipsoid;

/// `superellipsoid { <e, n> ... }`
pub(super) fn superellipsoid(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let [e, n] = p.vector2()?;
        Ok(Superellipsoid::try_new(e, n))
    })
}
