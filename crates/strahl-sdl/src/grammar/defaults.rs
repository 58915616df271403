use super::{Finish, Pigment, Texture};
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use std::sync::Arc;
use strahl_shade::Material;

/// What the grammar remembers between statements.
#[derive(Debug)]
pub struct State {
    /// What `#default` has set; objects begin with it.
    pub default_texture: Texture,
    /// Declared objects that are used as instances.
    pub(super) shared: super::objects::Shared,
    /// What `global_settings` has set.
    pub global: super::GlobalSettings,
    /// The last material made: neighbouring objects mostly share one.
    pub(super) last_material: Option<(Texture, Arc<Material>)>,
}

impl Default for State {
    fn default() -> Self {
        Self {
            default_texture: Texture {
                pigment: Pigment::default(),
                finish: Finish::default(),
            },
            shared: super::objects::Shared::default(),
            global: super::GlobalSettings::default(),
            last_material: None,
        }
    }
}

/// What stands in the braces of `#default`.
pub(crate) fn default_items(p: &mut Parser<'_>) -> PResult<()> {
    p.items("`#default`", |p, token| match token.word() {
        Some(Word::Pigment) => {
            p.take(token)?;
            p.state.default_texture.pigment = p.pigment_block()?;
            Ok(())
        }
        Some(Word::Finish) => {
            p.take(token)?;
            p.state.default_texture.finish = p.finish_block()?;
            Ok(())
        }
        Some(Word::Texture) => {
            p.take(token)?;
            p.state.default_texture = p.texture_block()?;
            Ok(())
        }
        _ => p.skip_item(token, "`#default`"),
    })
}
