//! Parts of a pigment, normal or finish that are written directly in the texture, as versions before 3.0 allow:
//! `texture { color red 1 bumps 0.5 phong 1 }`.
//!
//! Turbulence belongs to the pigment, frequency and phase to the normal; a single number is `crand` (measured with POV-Ray 3.7).

use super::{finish, modifiers, normal, pigment, top_of};
use crate::keywords::{Word, WordKind};
use crate::parser::{PResult, Parser};
use crate::token::{Kind, Token};
use std::sync::Arc;
use strahl_math::Transform;
use strahl_shade::patterns::Wave;
use strahl_shade::texture::Texture as Surface;

/// The version from which on all parts must be in their own blocks.
pub(super) const BLOCKS_SINCE: f64 = 3.0;

/// Pigment and normal while parts of them are read; they are taken from the texture, and put back when other items follow.
#[derive(Default)]
pub(super) struct Loose {
    pigment: Option<pigment::Draft>,
    normal: Option<normal::Draft>,
}

/// The block that a part belongs to.
enum Home {
    Pigment,
    Normal,
    Finish,
}

fn home(token: Token) -> Option<Home> {
    let Some(word) = token.word() else {
        return (token.kind == Kind::Number).then_some(Home::Finish);
    };
    Some(match word {
        Word::Agate
        | Word::Bozo
        | Word::Checker
        | Word::ColorMap
        | Word::ColourMap
        | Word::Gradient
        | Word::Granite
        | Word::Hexagon
        | Word::ImageMap
        | Word::Lambda
        | Word::Leopard
        | Word::Mandel
        | Word::Marble
        | Word::Octaves
        | Word::Omega
        | Word::Onion
        | Word::QuickColor
        | Word::QuickColour
        | Word::Spotted
        | Word::Turbulence
        | Word::Wood => Home::Pigment,
        Word::BumpMap
        | Word::BumpSize
        | Word::Bumps
        | Word::Dents
        | Word::Frequency
        | Word::Phase
        | Word::Ripples
        | Word::Waves
        | Word::Wrinkles => Home::Normal,
        Word::Ambient
        | Word::Brilliance
        | Word::Crand
        | Word::Diffuse
        | Word::Ior
        | Word::Metallic
        | Word::Phong
        | Word::PhongSize
        | Word::Reflection
        | Word::Refraction
        | Word::Roughness
        | Word::Specular => Home::Finish,
        _ if word.kind() == WordKind::Color => Home::Pigment,
        _ => return None,
    })
}

impl Loose {
    /// Transforms the parts read so far.
    pub(super) fn transform(&mut self, by: &Transform) {
        if let Some(pigment) = &mut self.pigment {
            modifiers::transform(&mut pigment.modifiers.warps, by);
        }
        if let Some(normal) = &mut self.normal {
            normal::transform(&mut normal.normal, by);
        }
    }

    /// Puts the parts read so far into the texture.
    pub(super) fn put_into(&mut self, texture: &mut Surface) {
        let Some(top) = top_of(texture) else {
            return;
        };
        if let Some(pigment) = self.pigment.take() {
            top.pigment = pigment.finish();
        }
        if let Some(normal) = self.normal.take() {
            top.normal = Some(Box::new(normal.finish()));
        }
    }
}

impl Parser<'_> {
    /// Reads a part that belongs to a block of the texture, if one follows.
    ///
    /// # Errors
    /// If it is invalid.
    pub(super) fn loose_item(
        &mut self,
        loose: &mut Loose,
        texture: &mut Surface,
        token: Token,
    ) -> PResult<bool> {
        // Textures that a pattern chooses from.
        let chooses = self.raw_ahead(1).is(Word::Texture);
        let (Some(home), Some(top), false) = (home(token), top_of(texture), chooses) else {
            return Ok(false);
        };
        match home {
            Home::Pigment => {
                let taken = &mut top.pigment;
                let draft = loose
                    .pigment
                    .get_or_insert_with(|| std::mem::take(taken).into());
                let wave = draft.modifiers.wave;
                self.pigment_item(draft, token)?;
                // Here marble and wood use a ramp wave instead of a triangle wave.
                if token.is(Word::Marble) || token.is(Word::Wood) {
                    draft.modifiers.wave = Some(wave.unwrap_or(Wave::Ramp));
                }
            }
            Home::Normal => {
                let taken = &mut top.normal;
                let draft = loose.normal.get_or_insert_with(|| {
                    let normal = taken.take().map_or_else(normal::flat, |normal| *normal);
                    normal.into()
                });
                self.normal_item(draft, token)?;
            }
            Home::Finish => {
                let finish = Arc::make_mut(&mut top.finish);
                if token.kind == Kind::Number {
                    finish.crand = self.float()?;
                } else {
                    self.finish_item(finish, &mut finish::Albedo::default(), token)?;
                }
            }
        }
        Ok(true)
    }
}
