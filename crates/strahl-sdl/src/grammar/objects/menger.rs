use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::Menger;

/// `menger { corner, corner, level ... }`
///
/// An extension.
pub(super) fn menger(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let corner = p.vector3()?;
        p.comma()?;
        let opposite = p.vector3()?;
        p.comma()?;
        let place = p.place();
        let level = p.float()?;
        if level.fract() != 0.0 || !(0.0..=f64::from(Menger::MAX_LEVEL)).contains(&level) {
            let message = format!(
                "the level of a sponge is a whole number from 0 to {}, found {level}",
                Menger::MAX_LEVEL
            );
            return Err(p.fail(place, message));
        }
        Ok(Menger::try_new(corner, opposite, level as u32))
    })
}
