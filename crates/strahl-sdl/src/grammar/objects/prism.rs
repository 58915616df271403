use crate::grammar::Entity;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use strahl_geometry::{Prism, PrismSweep, Spline};
use strahl_math::DVec2;

/// `prism { [spline] [sweep] height, height, count, points ... [open] }`
pub(super) fn prism(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let (mut spline, mut sweep) = (Spline::Linear, PrismSweep::Linear);
        loop {
            if let Some(found) = p.spline_word()? {
                spline = found;
            } else if p.accept_word(Word::LinearSweep)? {
                sweep = PrismSweep::Linear;
            } else if p.accept_word(Word::ConicSweep)? {
                sweep = PrismSweep::Conic;
            } else {
                break;
            }
        }
        let place = p.place();
        let a = p.float()?;
        p.comma()?;
        let b = p.float()?;
        p.comma()?;
        let least = match spline {
            Spline::Linear => 3,
            Spline::Quadratic => 5,
            Spline::Cubic => 6,
            Spline::Bezier => 4,
        };
        let points = p.spline_points("prism", spline, least)?;
        let open = p.accept_word(Word::Open)?;
        let prism = Prism::try_new(spline, sweep, [a, b], &points, open);
        if let Ok(prism) = &prism
            && prism.outline().gaps() > 0
        {
            p.warn(
                place,
                "a curve of the prism does not return to its first point; a line closes it",
            );
        }
        Ok(prism)
    })
}

impl Parser<'_> {
    /// The keyword of a kind of spline, if one follows.
    pub(super) fn spline_word(&mut self) -> PResult<Option<Spline>> {
        for (word, spline) in [
            (Word::LinearSpline, Spline::Linear),
            (Word::QuadraticSpline, Spline::Quadratic),
            (Word::CubicSpline, Spline::Cubic),
            (Word::BezierSpline, Spline::Bezier),
        ] {
            if self.accept_word(word)? {
                return Ok(Some(spline));
            }
        }
        Ok(None)
    }

    /// `count, point, ...` for a spline with at least this many points.
    pub(super) fn spline_points(
        &mut self,
        what: &str,
        spline: Spline,
        least: u32,
    ) -> PResult<Vec<DVec2>> {
        let count = self.float()?;
        let place = self.place();
        if !(count >= f64::from(least)) {
            let kind = match spline {
                Spline::Linear => "linear",
                Spline::Quadratic => "quadratic",
                Spline::Cubic => "cubic",
                Spline::Bezier => "B\u{e9}zier",
            };
            let message =
                format!("a {what} of {kind} splines has at least {least} points, found {count}");
            return Err(self.fail(place, message));
        }
        if spline == Spline::Bezier && count % 4.0 != 0.0 {
            let message = format!("B\u{e9}zier splines have four points per piece, found {count}");
            return Err(self.fail_hint(
                place,
                message,
                "the last point of a piece is written again as the first of the next",
            ));
        }
        let mut points = vec![];
        // Each point is read, so the count cannot ask for more memory than the text has.
        let mut read = 0.0;
        while read < count {
            self.comma()?;
            points.push(DVec2::from_array(self.vector2()?));
            read += 1.0;
        }
        Ok(points)
    }
}
