use crate::grammar::Entity;
use crate::keywords::Word;
use crate::parser::{PResult, Parser, Place};
use strahl_geometry::Cylinder;
use strahl_math::DVec3;

/// `cylinder { base, cap, radius [open] ... }`
pub(super) fn cylinder(p: &mut Parser<'_>) -> PResult<Entity> {
    let place = p.place();
    p.shape(|p| {
        let base = p.vector3()?;
        p.comma()?;
        let cap = p.vector3()?;
        p.comma()?;
        check_ends(p, place, "cylinder", base, cap)?;
        let radius = p.float()?.abs();
        let closed = Cylinder::try_new(base, cap, radius);
        let open = p.accept_word(Word::Open)?;
        Ok(closed.map(|c| {
            if open {
                Cylinder::open(base, cap, radius)
            } else {
                c
            }
        }))
    })
}

/// Reports an error if both ends are the same point, which leaves the direction undefined.
pub(super) fn check_ends(
    p: &mut Parser<'_>,
    place: Place,
    what: &str,
    base: DVec3,
    cap: DVec3,
) -> PResult<()> {
    if base != cap {
        return Ok(());
    }
    Err(p.fail_hint(
        place,
        format!(
            "both ends of the {what} are at <{}, {}, {}>",
            base.x, base.y, base.z
        ),
        "if a macro or loop creates it, skip it there with `#if`",
    ))
}
