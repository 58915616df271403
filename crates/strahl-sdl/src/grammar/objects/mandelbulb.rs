use crate::grammar::Entity;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use strahl_geometry::Mandelbulb;

/// `mandelbulb { power [max_iteration n] [precision p] [julia <x, y, z>] ... }`
///
/// An extension.
pub(super) fn mandelbulb(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let place = p.place();
        let power = p.float()?;
        if power.fract() != 0.0 || !(2.0..=f64::from(Mandelbulb::MAX_POWER)).contains(&power) {
            let message = format!(
                "the power of a mandelbulb is a whole number from 2 to {}, found {power}",
                Mandelbulb::MAX_POWER
            );
            return Err(p.fail(place, message));
        }
        p.comma()?;
        let (mut iterations, mut precision, mut parameter) = (8, 20.0, None);
        loop {
            if p.accept_word(Word::MaxIteration)? {
                let place = p.place();
                let count = p.float()?;
                if count.fract() != 0.0 || !(1.0..=1000.0).contains(&count) {
                    let message =
                        format!("`max_iteration` is a whole number from 1 to 1000, found {count}");
                    return Err(p.fail(place, message));
                }
                iterations = count as u32;
            } else if p.accept_word(Word::Precision)? {
                precision = p.float()?;
            } else if p.accept_word(Word::Julia)? {
                parameter = Some(p.vector3()?);
            } else {
                break;
            }
        }
        Ok(Mandelbulb::try_new(
            power as u32,
            parameter,
            iterations,
            precision,
        ))
    })
}
