//! The look of objects: pigments, normals, finishes, textures, interiors.
//!
//! `pattern` is the table of patterns, which pigments, normals and textures share; `modifiers` reads the items that modify any
//! pattern, `maps` the lists of `[position thing]`. Everything is read directly into the types of `strahl_shade`; only
//! [`Texture`], the look of an object, is defined in this crate.
//!
//! **Order and space.** A transformation moves everything written before it within its braces. A texture is in the object's own
//! space, inside of [`Object::transform`](strahl_scene::Object): a later transformation of the object moves its texture too, also
//! in copies, CSG objects and instances. Only a texture that is written *after* a transformation of its object needs that
//! transformation undone, by [`Texture::transformed`].

mod bitmap;
mod finish;
mod inside;
mod interior;
mod layers;
mod loose;
mod maps;
mod material;
mod modifiers;
mod normal;
mod palette;
mod pattern;
mod pigment;
mod statement;
mod weight;

pub(super) use bitmap::KnownPicture;
pub(super) use material::{KnownMaterials, fill_parts, is_bare, is_same_everywhere, placed};

pub use inside::inside;
pub use pattern::pattern_words;

use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::Token;
use std::sync::{Arc, LazyLock};
use strahl_math::Transform;
use strahl_shade::interior::Interior;
use strahl_shade::pigment::Pigment;
use strahl_shade::texture::{PlainTexture, Shares, Texture as Surface};

/// The look of an object: its surface and its interior.
#[derive(Clone, Debug, Default)]
pub struct Texture {
    /// The texture of the surface.
    pub surface: Arc<Surface>,
    /// The texture of the surface as seen from inside, if it is another.
    pub inner_surface: Option<Arc<Surface>>,
    /// The interior.
    pub interior: Option<Arc<Interior>>,
    /// Whether `surface` is written in the scene and is not the default: further textures are then layered over it.
    pub(super) written: bool,
    /// The textures of the components of a blob, which neither `surface` nor `inner_surface` replaces.
    pub(super) components: Option<Arc<Components>>,
}

/// Transforms a texture, except its parts in surface coordinates: neither the transformations of objects nor those behind the
/// texture reach them (measured).
fn transform(texture: &mut Surface, by: &Transform) {
    match texture {
        Surface::Plain(plain) => {
            pigment::transform(&mut plain.pigment, by);
            if let Some(normal) = &mut plain.normal {
                normal::transform(normal, by);
            }
        }
        Surface::Layered(layers) => layers.make_mut().iter_mut().for_each(|l| transform(l, by)),
        Surface::Map(field, _) | Surface::Blocks(field, _) => {
            modifiers::transform(&mut field.modifiers.warps, by);
        }
        Surface::Average(_, modifiers) | Surface::MaterialMap(_, modifiers, _) => {
            modifiers::transform(&mut modifiers.warps, by);
        }
        // Of a texture in surface coordinates, the normals follow the transformation, the rest does not.
        Surface::Shared(..) | Surface::UvMapped(_) => {
            let own = std::mem::take(texture);
            *texture = Surface::Transformed(Box::new(*by), Box::new(own));
        }
        Surface::Transformed(own, _) => **own = own.then(by),
    }
}

/// Whether a texture is uniform, so that transforming it changes nothing that is seen.
fn is_uniform(texture: &Surface) -> bool {
    match texture {
        Surface::Plain(plain) => {
            plain.normal.is_none() && matches!(plain.pigment, Pigment::Solid(..))
        }
        Surface::Layered(layers) => layers.iter().all(is_uniform),
        _ => false,
    }
}

/// The pigment, normal and finish of the uppermost layer, which further items change.
pub(super) fn top_of(texture: &mut Surface) -> Option<&mut PlainTexture> {
    match texture {
        Surface::Plain(plain) => Some(plain),
        Surface::Layered(layers) => layers.make_mut().last_mut().and_then(top_of),
        Surface::Transformed(_, inner) | Surface::UvMapped(inner) => top_of(inner),
        _ => None,
    }
}

/// The textures of parts of one surface, and their shares at its points; number 0 is the texture of the whole.
#[derive(Clone, Debug)]
pub(super) struct Components {
    pub shares: Arc<dyn Shares>,
    /// The textures from number 1 on.
    pub own: Vec<Arc<Surface>>,
}

impl Components {
    /// The texture of the whole and of these parts.
    fn around(&self, whole: Surface) -> Surface {
        let own = self.own.iter().map(|own| Surface::clone(own));
        let members = std::iter::once(whole).chain(own).collect();
        Surface::Shared(Arc::clone(&self.shares), members)
    }
}

impl Texture {
    /// The texture after a transformation of its space; parts in surface coordinates stay.
    #[must_use]
    pub fn transformed(&self, by: &Transform) -> Self {
        // The default colour is not moved with the object (measured).
        self.moved(by, !self.written)
    }

    /// The same for a texture into which nothing more is written: uniform ones stay shared.
    #[must_use]
    pub(super) fn placed(&self, by: &Transform) -> Self {
        self.moved(by, true)
    }

    fn moved(&self, by: &Transform, uniform_stays: bool) -> Self {
        let moved = |surface: &Arc<Surface>| {
            if by.is_identity() || uniform_stays && is_uniform(surface) {
                return Arc::clone(surface);
            }
            let mut surface = Surface::clone(surface);
            transform(&mut surface, by);
            Arc::new(surface)
        };
        Self {
            surface: moved(&self.surface),
            inner_surface: self.inner_surface.as_ref().map(moved),
            interior: self.interior.clone(),
            written: self.written,
            components: self.components.as_ref().map(|components| {
                Arc::new(Components {
                    shares: Arc::clone(&components.shares),
                    own: components.own.iter().map(moved).collect(),
                })
            }),
        }
    }

    /// Pigment, normal and finish of the uppermost layer; for patterned textures, the defaults of the language.
    pub(super) fn top(&self) -> &PlainTexture {
        static DEFAULT: LazyLock<PlainTexture> = LazyLock::new(PlainTexture::default);
        let mut texture = &*self.surface;
        loop {
            texture = match texture {
                Surface::Plain(plain) => return plain,
                Surface::Layered(layers) => match layers.last() {
                    Some(top) => top,
                    None => return &DEFAULT,
                },
                Surface::Transformed(_, inner) | Surface::UvMapped(inner) => inner,
                _ => return &DEFAULT,
            };
        }
    }

    /// Drops the modifiers of the uppermost layer's pigment if it is one colour.
    pub(super) fn forget_modifiers_of_color(&mut self) {
        let is_modified =
            |plain: &PlainTexture| matches!(plain.pigment, Pigment::Solid(_, Some(_)));
        if is_modified(self.top())
            && let Some(top) = top_of(Arc::make_mut(&mut self.surface))
            && let Pigment::Solid(_, kept) = &mut top.pigment
        {
            *kept = None;
        }
    }

    /// Layers a texture over those written before, or replaces the default.
    fn cover(&mut self, p: &mut Parser<'_>, surface: Arc<Surface>) -> PResult<()> {
        let lower = self.written.then_some(&self.surface);
        self.surface = p.layered_over(lower, surface)?;
        self.written = true;
        Ok(())
    }

    /// Layers a texture over those written before for the inside.
    fn cover_inside(&mut self, p: &mut Parser<'_>, surface: Arc<Surface>) -> PResult<()> {
        self.inner_surface = Some(p.layered_over(self.inner_surface.as_ref(), surface)?);
        Ok(())
    }
}

impl Parser<'_> {
    /// Reads an item of an object's look, if one follows: `pigment`, `normal`, `finish`, `texture`, `interior_texture`,
    /// `interior`, `material`.
    ///
    /// # Errors
    /// If it is invalid.
    pub(super) fn texture_item(&mut self, texture: &mut Texture, token: Token) -> PResult<bool> {
        match token.word() {
            Some(Word::Pigment | Word::Normal | Word::Finish) => {
                self.plain_item(Arc::make_mut(&mut texture.surface), token)?;
                texture.written = true;
            }
            Some(Word::Texture) => {
                self.take(token)?;
                let surface = self.surface_block()?;
                texture.cover(self, surface)?;
            }
            Some(Word::InteriorTexture) => {
                self.take(token)?;
                let surface = self.surface_block()?;
                texture.cover_inside(self, surface)?;
            }
            Some(Word::Interior) => {
                self.take(token)?;
                let base = texture.interior.as_deref();
                texture.interior = Some(Arc::new(self.interior_block(base)?));
            }
            Some(Word::Material) => {
                self.take(token)?;
                self.material_block(texture)?;
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// `upper` over `lower`, if there is one.
    fn layered_over(
        &mut self,
        lower: Option<&Arc<Surface>>,
        upper: Arc<Surface>,
    ) -> PResult<Arc<Surface>> {
        let mut surface = match lower {
            None => upper,
            Some(lower) => {
                self.weigh(weight::of_texture(lower))?;
                let lower = Surface::clone(lower);
                Arc::new(layers::layered(lower, Surface::clone(&upper)))
            }
        };
        self.layers_of_version(&mut surface);
        Ok(surface)
    }

    /// `pigment`, `normal` or `finish` with its block, changing the uppermost layer.
    fn plain_item(&mut self, surface: &mut Surface, token: Token) -> PResult<()> {
        self.take(token)?;
        let place = self.place();
        let mut unused;
        let top = if let Some(top) = top_of(surface) {
            top
        } else {
            let word = token.word().map_or("", Word::text);
            self.warn_hint(
                place,
                format!("this `{word}` has no effect: the texture is made of other textures"),
                format!("write the `{word}` into those"),
            );
            unused = PlainTexture::default();
            &mut unused
        };
        match token.word() {
            Some(Word::Pigment) => {
                let base = std::mem::take(&mut top.pigment);
                top.pigment = self.pigment_block_on(base)?;
            }
            Some(Word::Normal) => {
                let base = top.normal.take();
                top.normal = Some(Box::new(self.normal_block_on(base.map(|n| *n))?));
            }
            _ => top.finish = self.finish_block_on(Arc::clone(&top.finish))?,
        }
        Ok(())
    }
}
