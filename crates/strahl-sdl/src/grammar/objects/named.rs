use crate::grammar::Thing;
use crate::keywords::{Word, WordKind};
use crate::parser::{PResult, Parser};
use strahl_scene::Object;

/// `object { Name ... }` or `object { sphere { ... } ... }`
pub(super) fn object(p: &mut Parser<'_>) -> PResult<Object> {
    let place = p.place();
    p.braces(|p| {
        let named = p.accept_thing(|thing| match thing {
            Thing::Object(object) => Some(object),
            _ => None,
        })?;
        let mut object = match named {
            Some(named) => {
                // Rays then name the place that put the object into the scene.
                let span = p.span_at(place);
                Object {
                    span,
                    ..Object::clone(&named)
                }
            }
            None => match p.object()? {
                Some(object) => object,
                None => {
                    let token = p.peek()?;
                    let kind = token.word().map(Word::kind);
                    let expected = match kind {
                        Some(WordKind::Object) => {
                            "an object of a kind that is known (this one is not supported yet)"
                        }
                        _ => "an object",
                    };
                    return Err(p.unexpected(token, expected));
                }
            },
        };
        p.modifiers(&mut object)?;
        Ok(object)
    })
}
