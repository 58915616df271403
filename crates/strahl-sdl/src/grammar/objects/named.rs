use crate::grammar::{Entity, Thing};
use crate::parser::{PResult, Parser};

/// `object { Name ... }` or `object { sphere { ... } ... }`
pub(in crate::grammar) fn object(p: &mut Parser<'_>) -> PResult<Entity> {
    let place = p.place();
    p.braces(|p| {
        let token = p.peek()?;
        let named = p.accept_thing(|thing| match thing {
            Thing::Object(object) => Some(object),
            _ => None,
        })?;
        let mut entity = match named {
            Some(declared) => {
                let mut entity = p.use_declared(&declared);
                // Rays then name the place that put the object into the scene.
                entity.object.span = p.span_at(place);
                if let Some(symbol) = token.symbol() {
                    entity.object.name = Some(p.name_of(symbol));
                }
                entity
            }
            None => match p.entity()? {
                Some(entity) => entity,
                None => {
                    let token = p.peek()?;
                    return Err(p.unexpected(token, "an object"));
                }
            },
        };
        p.modifiers(&mut entity)?;
        Ok(entity)
    })
}
