//! How surfaces look: pigments, finishes and textures.

mod finish;
mod material;
mod pigment;

pub use finish::Finish;
pub use pigment::Pigment;

use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::Token;
use strahl_math::Transform;

/// A pigment with a finish.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The colour.
    pub pigment: Pigment,
    /// How the surface takes light.
    pub finish: Finish,
}

impl Texture {
    /// The texture moved along with an object. It is the same everywhere, so it stays what it is.
    #[must_use]
    pub(in crate::grammar) fn transformed(self, _map: &Transform) -> Self {
        self
    }
}

impl Parser<'_> {
    /// `{ ... }` behind `texture`.
    pub(super) fn texture_block(&mut self) -> PResult<Texture> {
        let mut texture = self.state.default_texture.clone();
        self.braces(|p| {
            let named = p.accept_thing(|thing| match thing {
                super::Thing::Texture(t) => Some(t),
                _ => None,
            })?;
            if let Some(named) = named {
                texture = Texture::clone(&named);
            }
            p.items("`texture`", |p, token| {
                if p.texture_item(&mut texture, token)? || p.transformation(token)?.is_some() {
                    return Ok(());
                }
                p.skip_item(token, "`texture`")
            })
        })?;
        Ok(texture)
    }

    /// `pigment` or `finish` with its block, in a texture or directly in an object; `false` if none stands here.
    pub(super) fn texture_item(&mut self, texture: &mut Texture, token: Token) -> PResult<bool> {
        match token.word() {
            Some(Word::Pigment) => {
                self.take(token)?;
                texture.pigment = self.pigment_block()?;
            }
            Some(Word::Finish) => {
                self.take(token)?;
                texture.finish = self.finish_block()?;
            }
            _ => return Ok(false),
        }
        Ok(true)
    }
}
