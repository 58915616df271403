use super::cylinder::check_ends;
use crate::grammar::Entity;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use strahl_geometry::{Cone, GeometryError};

/// `cone { base, radius, cap, radius [open] ... }`
pub(super) fn cone(p: &mut Parser<'_>) -> PResult<Entity> {
    let place = p.place();
    p.shape(|p| {
        let base = p.vector3()?;
        p.comma()?;
        let base_radius = p.float()?;
        p.comma()?;
        let cap = p.vector3()?;
        p.comma()?;
        let cap_radius = p.float()?;
        check_ends(p, place, "cone", base, cap)?;
        if base_radius < 0.0 || cap_radius < 0.0 {
            p.warn(
                place,
                "a radius of the cone is negative; its absolute value is used",
            );
        }
        let open = p.accept_word(Word::Open)?;
        let (base_radius, cap_radius) = (base_radius.abs(), cap_radius.abs());
        if base_radius == 0.0 && cap_radius == 0.0 {
            return Ok(Err(GeometryError::Degenerate {
                what: "cone",
                why: "both radii are zero",
            }));
        }
        let cone = Cone::try_new(base, base_radius, cap, cap_radius);
        Ok(cone.map(|closed| {
            if open {
                Cone::open(base, base_radius, cap, cap_radius)
            } else {
                closed
            }
        }))
    })
}
