//! Objects: a file each, and a line in [`OBJECTS`].

mod boxes;
mod modifiers;
mod named;
mod plane;
mod sphere;

use super::by_word;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use strahl_scene::Object;

/// Reads an object from its `{` to its `}`; its word is already taken.
type ObjectParser = fn(&mut Parser<'_>) -> PResult<Object>;

/// All objects by their words.
static OBJECTS: [Option<ObjectParser>; Word::ALL.len()] = by_word::<ObjectParser, _>([
    (Word::Box, boxes::cuboid),
    (Word::Object, named::object),
    (Word::Plane, plane::plane),
    (Word::Sphere, sphere::sphere),
]);

impl Parser<'_> {
    /// If an object stands here, reads it.
    ///
    /// # Errors
    /// If the object is wrong.
    pub(crate) fn object(&mut self) -> PResult<Option<Object>> {
        let token = self.peek()?;
        let parse = token
            .word()
            .and_then(|w| OBJECTS.get(w as usize).copied().flatten());
        match parse {
            Some(parse) => {
                self.take(token)?;
                self.nested(parse).map(Some)
            }
            None => Ok(None),
        }
    }
}
