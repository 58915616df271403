use super::cylinder::check_ends;
use crate::grammar::Entity;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use strahl_geometry::Lemon;

/// `lemon { base, radius, cap, radius, inner_radius [open] [sturm] ... }`
pub(super) fn lemon(p: &mut Parser<'_>) -> PResult<Entity> {
    let place = p.place();
    p.shape(|p| {
        let base = p.vector3()?;
        p.comma()?;
        let base_radius = p.float()?;
        p.comma()?;
        let cap = p.vector3()?;
        p.comma()?;
        let cap_radius = p.float()?;
        p.comma()?;
        let inner_place = p.place();
        let inner = p.float()?;
        check_ends(p, place, "lemon", base, cap)?;
        let least = Lemon::least_inner_radius((cap - base).length(), base_radius, cap_radius);
        let inner = if inner < least {
            p.warn_hint(
                inner_place,
                format!("the inner radius of the lemon, {inner}, is too small"),
                format!("the least one is used: {least}"),
            );
            least
        } else {
            inner
        };
        let mut is_open = false;
        loop {
            if p.accept_word(Word::Open)? {
                is_open = true;
            } else if !p.accept_word(Word::Sturm)? {
                break;
            }
        }
        let lemon = Lemon::try_new(base, base_radius, cap, cap_radius, inner);
        Ok(lemon.map(|lemon| if is_open { lemon.open() } else { lemon }))
    })
}
