use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::Superellipsoid;

/// The exponent that is taken for 0, for which POV-Ray shows sharp edges (measured).
const SHARP: f64 = 1e-3;

/// `superellipsoid { <e, n> ... }`
pub(super) fn superellipsoid(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let [e, n] = p.vector2()?.map(|x| if x == 0.0 { SHARP } else { x });
        Ok(Superellipsoid::try_new(e, n))
    })
}
