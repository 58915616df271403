use crate::grammar::Entity;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use strahl_geometry::Ovus;

/// `ovus { bottom_radius, top_radius [sturm] ... }`
pub(super) fn ovus(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let bottom = p.float()?;
        p.comma()?;
        let top = p.float()?;
        p.comma()?;
        // The root finder of POV-Ray, which is ignored.
        p.accept_word(Word::Sturm)?;
        Ok(Ovus::try_new(bottom, top))
    })
}
