use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::Disc;

/// `disc { centre, normal, radius [, radius of the hole] ... }`
pub(super) fn disc(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let center = p.vector3()?;
        p.comma()?;
        let normal = p.vector3()?;
        p.comma()?;
        let radius = p.float()?;
        p.comma()?;
        let hole = if p.number_follows()? { p.float()? } else { 0.0 };
        Ok(Disc::try_new(center, normal, radius, hole))
    })
}
