use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::{Lathe, Spline};

/// `lathe { [spline] count, points ... }` about the y axis
pub(super) fn lathe(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let mut spline = Spline::Linear;
        while let Some(found) = p.spline_word()? {
            spline = found;
        }
        let least = match spline {
            Spline::Linear => 2,
            Spline::Quadratic => 3,
            Spline::Cubic | Spline::Bezier => 4,
        };
        let points = p.spline_points("lathe", spline, least)?;
        Ok(Lathe::try_new(spline, &points))
    })
}
