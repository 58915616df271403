//! Declared objects: `object { Name ... }`, `Name`, and names in the braces of other objects.

use crate::grammar::entity::Declared;
use crate::grammar::{Entity, Thing};
use crate::parser::{PResult, Parser, Place};
use crate::token::{Kind, Token};
use crate::value::Value;
use std::sync::Arc;

/// `object { Name ... }` or `object { sphere { ... } ... }`
pub(in crate::grammar) fn object(p: &mut Parser<'_>) -> PResult<Entity> {
    let place = p.place();
    p.braces(|p| {
        let mut entity = match p.named_object(Some(place))? {
            Some(entity) => entity,
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

impl Parser<'_> {
    /// Takes the name of an object, if one follows, and returns the object. Hits refer to `place`, where the object is put into
    /// the scene, or to the name itself.
    ///
    /// # Errors
    /// If the name is that of an array or dictionary, and its element is not an object.
    pub(in crate::grammar) fn named_object(
        &mut self,
        place: Option<Place>,
    ) -> PResult<Option<Entity>> {
        let token = self.peek()?;
        if token.kind != Kind::Name {
            return Ok(None);
        }
        let place = place.unwrap_or_else(|| self.place_of(token));
        let named = self.accept_thing(|thing| match thing {
            Thing::Object(object) => Some(object),
            _ => None,
        })?;
        Ok(named.map(|declared| self.declared_object(&declared, token, place)))
    }

    /// The declared object, as used by `name`.
    pub(in crate::grammar) fn declared_object(
        &mut self,
        declared: &Arc<Declared>,
        name: Token,
        place: Place,
    ) -> Entity {
        let mut entity = self.use_declared(declared);
        entity.object.span = self.span_at(place);
        if let Some(symbol) = name.symbol() {
            entity.object.name = Some(self.name_of(symbol));
        }
        entity
    }

    /// Whether a brace and the name of an object follow: `sphere { Name ... }` means `object { Name ... }`.
    ///
    /// # Errors
    /// If a directive after the brace fails.
    pub(super) fn object_name_follows(&mut self) -> PResult<bool> {
        if self.raw().kind != Kind::LeftBrace {
            return Ok(false);
        }
        let token = self.peek_into_braces()?;
        Ok(self.names_object(token))
    }

    /// Whether a token is the name of an object, or of an array of objects.
    fn names_object(&self, token: Token) -> bool {
        let (Kind::Name, Some(symbol)) = (token.kind, token.symbol()) else {
            return false;
        };
        let is_object = |value: &Value| matches!(value, Value::Thing(Thing::Object(_)));
        match self.scopes.find(symbol) {
            Some(Value::Array(array)) => array
                .elements()
                .iter()
                .flatten()
                .next()
                .is_some_and(is_object),
            found => found.is_some_and(is_object),
        }
    }
}
