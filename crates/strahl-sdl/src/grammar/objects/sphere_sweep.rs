use crate::grammar::Entity;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use strahl_geometry::{SphereSweep, SweepSpline};

/// `sphere_sweep { spline count, center, radius, ... [tolerance t] }`
pub(super) fn sphere_sweep(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let token = p.peek()?;
        let spline = match token.word() {
            Some(Word::LinearSpline) => SweepSpline::Linear,
            Some(Word::BSpline) => SweepSpline::BSpline,
            Some(Word::CubicSpline) => SweepSpline::Cubic,
            _ => {
                let expected = "`linear_spline`, `b_spline` or `cubic_spline`";
                return Err(p.unexpected(token, expected));
            }
        };
        p.take(token)?;
        p.comma()?;
        let count = p.float()?;
        let place = p.place();
        if !(count >= spline.least() as f64) {
            let least = spline.least();
            let message = format!(
                "a sphere sweep of this spline has at least {least} spheres, found {count}"
            );
            return Err(p.fail(place, message));
        }
        let mut spheres = vec![];
        // Each sphere is read, so the count cannot ask for more memory than the text has.
        let mut read = 0.0;
        while read < count {
            p.comma()?;
            let center = p.vector3()?;
            p.comma()?;
            spheres.push((center, p.float()?));
            read += 1.0;
        }
        p.comma()?;
        // The precision of POV-Ray's root finder, which is ignored.
        if p.accept_word(Word::Tolerance)? {
            p.float()?;
        }
        Ok(SphereSweep::try_new(spline, &spheres))
    })
}
