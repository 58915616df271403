//! `filter` and `transmit` in pictures: of single entries of the palette, or of all.

use super::bitmap::PictureFile;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use std::sync::Arc;
use strahl_formats::image::{PaletteIndices, decode_indices};
use strahl_shade::image_map::{ImageMap, PaletteTransparency};
use strahl_shade::image_texture::TextureImage;

impl Parser<'_> {
    /// `N, V` or `all V` after `filter` or `transmit`.
    ///
    /// In a picture with a palette both set entries, replacing what the file and earlier items say, so the last item counts; in
    /// other pictures `all` is added to every texel (measured).
    pub(super) fn picture_transparency(
        &mut self,
        map: &mut ImageMap,
        file: Option<&PictureFile>,
        word: Word,
    ) -> PResult<()> {
        self.with_palette(map, file)?;
        let which = usize::from(word == Word::Transmit);
        if self.accept_word(Word::All)? {
            let amount = self.float()?;
            match &mut map.palette {
                Some(palette) => {
                    for entry in &mut Arc::make_mut(palette).entries {
                        entry[which] = amount;
                    }
                }
                None if word == Word::Filter => map.filter_all = amount,
                None => map.transmit_all = amount,
            }
            return Ok(());
        }
        let place = self.place();
        let number = self.whole(0, 255)? as usize;
        self.comma()?;
        let amount = self.float()?;
        let Some(palette) = &mut map.palette else {
            return Err(self.fail_hint(
                place,
                format!(
                    "this picture has no palette, so `{}` cannot set entry {number}",
                    word.text()
                ),
                format!("write `{} all` for the whole picture", word.text()),
            ));
        };
        let entries = &mut Arc::make_mut(palette).entries;
        let count = entries.len();
        match entries.get_mut(number) {
            Some(entry) => entry[which] = amount,
            None => {
                return Err(self.fail(
                    place,
                    format!(
                        "the palette has {count} entries, from 0 on; there is no entry {number}"
                    ),
                ));
            }
        }
        Ok(())
    }

    /// Reads the palette's entry of each texel, if the picture has a palette and it was not read before.
    fn with_palette(&mut self, map: &mut ImageMap, file: Option<&PictureFile>) -> PResult<()> {
        let Some((name, place)) = file.filter(|_| map.palette.is_none()) else {
            return Ok(());
        };
        let data = self.read_file(name, *place)?;
        match decode_indices(&data.bytes, name) {
            Ok(indices) => map.palette = indices.and_then(|found| entries(&map.image, found)),
            Err(error) => return Err(self.fail(*place, error.to_string())),
        }
        Ok(())
    }
}

/// The entries as the file has them: the alpha of an entry is that of its texels.
fn entries(image: &TextureImage, found: PaletteIndices) -> Option<Arc<PaletteTransparency>> {
    if (found.width, found.height) != (image.width(), image.height()) {
        return None;
    }
    let mut entries = vec![[0.0; 2]; found.colors];
    let width = found.width as usize;
    for (place, &index) in found.indices.iter().enumerate() {
        if let Some(entry) = entries.get_mut(usize::from(index)) {
            let (column, row) = ((place % width) as u32, (place / width) as u32);
            let [.., alpha] = image.fetch(column, row).map(f64::from);
            entry[1] = 1.0 - alpha;
        }
    }
    Some(Arc::new(PaletteTransparency {
        indices: found.indices.into(),
        entries,
    }))
}
