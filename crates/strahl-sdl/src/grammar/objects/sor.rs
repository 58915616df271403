use crate::grammar::Entity;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use strahl_geometry::{Sor, Spline};

/// `sor { count, points ... [open] }` about the y axis
pub(super) fn sor(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let points = p.spline_points("surface of revolution", Spline::Cubic, 4)?;
        let open = p.accept_word(Word::Open)?;
        Ok(Sor::try_new(&points, open))
    })
}
