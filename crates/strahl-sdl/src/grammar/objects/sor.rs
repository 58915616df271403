use crate::grammar::Entity;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use strahl_geometry::{Sor, Spline};

/// `sor { count, points ... [open] }` about the y axis
pub(super) fn sor(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let place = p.place();
        let points = p.spline_points("surface of revolution", Spline::Cubic, 4)?;
        if !Sor::is_rising(&points) {
            // An error in POV-Ray too.
            return Err(p.fail_hint(
                place,
                "the heights of a surface of revolution must grow from the second point to the last but one",
                "write a `lathe` for a curve that goes down or has a level part",
            ));
        }
        let open = p.accept_word(Word::Open)?;
        Ok(Sor::try_new(&points, open))
    })
}
