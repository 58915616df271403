use super::bytes::{Folder, path_beside, read_beside};
use crate::image::{TextureUse, decode_texture};
use std::collections::HashMap;
use std::sync::Arc;
use strahl_shade::image_texture::TextureImage;

/// Reads the textures a scene names, each once.
#[derive(Debug)]
pub(crate) struct TextureFiles<'a> {
    folder: Option<&'a Folder>,
    known: HashMap<(String, TextureUse), Result<Arc<TextureImage>, String>>,
}

impl<'a> TextureFiles<'a> {
    pub(crate) fn new(folder: Option<&'a Folder>) -> Self {
        Self {
            folder,
            known: HashMap::new(),
        }
    }

    /// The texture of a file beside the scene, or why there is none.
    pub(crate) fn get(
        &mut self,
        relative: &str,
        texture_use: TextureUse,
    ) -> Result<Arc<TextureImage>, String> {
        let path = path_beside(relative)?;
        let Self { folder, known } = self;
        let read = |path: &str| {
            let bytes = read_beside(*folder, path)?;
            decode_texture(&bytes, path, texture_use)
                .map(Arc::new)
                .map_err(|e| e.to_string())
        };
        known
            .entry((path, texture_use))
            .or_insert_with_key(|(path, _)| read(path))
            .clone()
    }
}
