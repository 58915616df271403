use crate::grammar::Texture;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::Token;
use strahl_geometry::{GeometryError, Shape};
use strahl_math::Transform;
use strahl_scene::{Object, ObjectExt};

/// What stands in an object besides its numbers, gathered until the brace closes.
pub(crate) struct Draft {
    transform: Option<Transform>,
    texture: Option<Texture>,
    shadows: Option<bool>,
}

impl Parser<'_> {
    /// A simple object: its numbers, read by `f` from the opening brace on, then what all objects may have.
    ///
    /// # Errors
    /// If the text or the shape is wrong.
    pub(crate) fn shape<S: Into<Shape>>(
        &mut self,
        f: impl FnOnce(&mut Self) -> PResult<Result<S, GeometryError>>,
    ) -> PResult<Object> {
        let place = self.place();
        self.braces(|p| {
            let shape = match f(p)? {
                Ok(shape) => shape,
                Err(error) => return Err(p.fail(place, error.to_string())),
            };
            let mut object = Object::from(shape);
            object.span = p.span_at(place);
            p.modifiers(&mut object)?;
            if object.material.is_none() {
                let texture = p.state.default_texture.clone();
                object.material = Some(p.material(&texture));
            }
            Ok(object)
        })
    }

    /// Transformations, textures and switches up to the closing brace.
    ///
    /// # Errors
    /// If an item is wrong.
    pub(crate) fn modifiers(&mut self, object: &mut Object) -> PResult<()> {
        let mut draft = Draft {
            transform: None,
            texture: None,
            shadows: None,
        };
        self.items("the object", |p, token| {
            if p.modifier(&mut draft, token)? {
                return Ok(());
            }
            p.skip_item(token, "the object")
        })?;
        if let Some(texture) = &draft.texture {
            object.material = Some(self.material(texture));
        }
        if let Some(shadow) = draft.shadows {
            object.visibility.shadow = shadow;
        }
        if let Some(transform) = &draft.transform {
            let moved = std::mem::replace(object, Object::csg(strahl_scene::CsgOp::Union, vec![]));
            *object = moved.transformed(transform);
        }
        Ok(())
    }

    fn modifier(&mut self, draft: &mut Draft, token: Token) -> PResult<bool> {
        if let Some(next) = self.transformation(token)? {
            draft.transform = Some(match &draft.transform {
                Some(before) => before.then(&next),
                None => next,
            });
            return Ok(true);
        }
        match token.word() {
            Some(Word::Pigment | Word::Finish) => {
                let default = &self.state.default_texture;
                let mut texture = draft.texture.take().unwrap_or_else(|| default.clone());
                self.texture_item(&mut texture, token)?;
                draft.texture = Some(texture);
            }
            Some(Word::Texture) => {
                self.take(token)?;
                draft.texture = Some(self.texture_block()?);
            }
            Some(Word::NoShadow) => {
                self.take(token)?;
                draft.shadows = Some(false);
            }
            // Matters for media and fog only, and there are none.
            Some(Word::Hollow) => {
                self.take(token)?;
                let switch = self.peek()?;
                if switch
                    .word()
                    .is_some_and(|w| w.kind() == crate::keywords::WordKind::Constant)
                {
                    self.take(switch)?;
                }
            }
            _ => return Ok(false),
        }
        Ok(true)
    }
}
