use super::Texture;
use super::objects::{KnownFont, KnownIsosurfaces};
use super::texture::{KnownMaterials, KnownPicture, top_of};
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use std::sync::Arc;
use strahl_shade::Color;
use strahl_shade::patterns::DensityGrid;
use strahl_shade::pov_finish::PovFinish;

/// State that the grammar keeps between statements.
#[derive(Debug, Default)]
pub struct State {
    /// The texture that `#default` has set; objects begin with it.
    pub default_texture: Texture,
    /// Declared objects that are used as instances.
    pub(super) shared: super::objects::Shared,
    /// The settings of `global_settings`.
    pub global: super::GlobalSettings,
    /// The finish read last.
    pub(super) last_finish: Arc<PovFinish>,
    /// Materials to be shared.
    pub(super) materials: KnownMaterials,
    /// The number of objects created.
    pub(super) objects: u64,
    /// The number of parts of textures and meshes created.
    pub(super) parts: u64,
    /// The pictures read so far.
    pub(super) pictures: Vec<KnownPicture>,
    /// The density files read so far, by name.
    pub(super) densities: Vec<(String, Arc<DensityGrid>)>,
    /// The fonts read so far.
    pub(super) fonts: Vec<KnownFont>,
    /// Isosurfaces to be shared.
    pub(super) isosurfaces: KnownIsosurfaces,
}

impl State {
    /// Objects that say nothing about it don't glow.
    pub(crate) fn darken(&mut self) {
        if let Some(top) = top_of(Arc::make_mut(&mut self.default_texture.surface)) {
            Arc::make_mut(&mut top.finish).ambient = Color::BLACK;
        }
    }
}

/// The items in the braces of `#default`.
pub(crate) fn default_items(p: &mut Parser<'_>) -> PResult<()> {
    p.items("`#default`", |p, token| {
        let mut texture = p.state.default_texture.clone();
        // The default texture is not a layer.
        texture.written = false;
        if matches!(
            token.word(),
            Some(Word::Pigment | Word::Normal | Word::Finish | Word::Texture)
        ) && p.texture_item(&mut texture, token)?
        {
            texture.written = false;
            p.state.default_texture = texture;
            return Ok(());
        }
        p.skip_item(token, "`#default`")
    })
}
