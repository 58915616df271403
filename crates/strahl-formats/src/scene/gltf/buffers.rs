use crate::input::Folder;
use crate::input::bytes::{path_beside, read_beside};
use base64::alphabet;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};
use base64::engine::{DecodePaddingMode, Engine as _};
use gltf_json::buffer::View;
use gltf_json::{Index, Root};
use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

/// The bytes of all buffers.
pub(super) struct Buffers<'a> {
    root: &'a Root,
    buffers: Vec<Bytes<'a>>,
}

enum Bytes<'a> {
    Chunk(&'a [u8]),
    File(Arc<Vec<u8>>),
}

impl<'a> Buffers<'a> {
    /// Reads all buffers: the binary chunk, data in the JSON, and files beside the scene (each once).
    pub(super) fn read(
        root: &'a Root,
        blob: Option<&'a [u8]>,
        folder: Option<&Folder>,
    ) -> Result<Self, String> {
        let mut files: HashMap<String, Arc<Vec<u8>>> = HashMap::new();
        let mut buffers = vec![];
        for (i, buffer) in root.buffers.iter().enumerate() {
            let bytes = match (buffer.uri.as_deref(), blob) {
                (None, Some(blob)) if i == 0 => Bytes::Chunk(blob),
                (None, _) => return Err(format!("buffer {i} has no data")),
                (Some(uri), _) => {
                    let mut read = || -> Result<Bytes<'a>, String> {
                        if uri.starts_with("data:") {
                            return Ok(Bytes::File(Arc::new(data_uri(uri)?)));
                        }
                        let path = path_beside(&decoded(uri))?;
                        if let Some(known) = files.get(&path) {
                            return Ok(Bytes::File(Arc::clone(known)));
                        }
                        let bytes = Arc::new(read_beside(folder, &path)?);
                        files.insert(path, Arc::clone(&bytes));
                        Ok(Bytes::File(bytes))
                    };
                    read().map_err(|why| {
                        format!("buffer {i} (`{}`) is not read: {why}", shown(uri))
                    })?
                }
            };
            let (found, expected) = (bytes.all().len() as u64, buffer.byte_length.0);
            if found < expected {
                return Err(format!(
                    "buffer {i} has {found} bytes instead of {expected}"
                ));
            }
            buffers.push(bytes);
        }
        Ok(Self { root, buffers })
    }

    /// The number of bytes; a file shared by several buffers counts several times.
    pub(super) fn total(&self) -> u64 {
        self.buffers.iter().map(|b| b.all().len() as u64).sum()
    }

    /// The bytes of a view and its stride.
    pub(super) fn view(&self, index: Index<View>) -> Result<(&[u8], Option<usize>), String> {
        let i = index.value();
        let view = self
            .root
            .buffer_views
            .get(i)
            .ok_or_else(|| format!("there is no buffer view {i}"))?;
        let buffer = self
            .buffers
            .get(view.buffer.value())
            .map(Bytes::all)
            .unwrap_or_default();
        let range = || {
            let start = usize::try_from(view.byte_offset.map_or(0, |offset| offset.0)).ok()?;
            let length = usize::try_from(view.byte_length.0).ok()?;
            buffer.get(start..start.checked_add(length)?)
        };
        let bytes = range().ok_or_else(|| format!("buffer view {i} reaches beyond its buffer"))?;
        Ok((bytes, view.byte_stride.map(|stride| stride.0)))
    }
}

impl Bytes<'_> {
    fn all(&self) -> &[u8] {
        match self {
            Self::Chunk(bytes) => bytes,
            Self::File(bytes) => bytes,
        }
    }
}

/// With or without the `=` at its end.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The bytes of a `data:` URI.
pub(super) fn data_uri(uri: &str) -> Result<Vec<u8>, String> {
    let data = uri.strip_prefix("data:").unwrap_or(uri);
    let data = data.split_once(";base64,").map_or(data, |(_, data)| data);
    let mut bytes = BASE64
        .decode(data)
        .map_err(|e| format!("its data is damaged: {e}"))?;
    // Some writers count the padding to whole words, too.
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    Ok(bytes)
}

/// A URI with its percent-encoding decoded.
pub(super) fn decoded(uri: &str) -> Cow<'_, str> {
    if !uri.contains('%') {
        return Cow::Borrowed(uri);
    }
    let mut bytes = vec![];
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let hex = |b: u8| char::from(b).to_digit(16);
        let code = match after {
            [high, low, ..] if first == b'%' => hex(*high).zip(hex(*low)),
            _ => None,
        };
        match code {
            Some((high, low)) => {
                bytes.push((high * 16 + low) as u8);
                rest = &after[2..];
            }
            None => {
                bytes.push(first);
                rest = after;
            }
        }
    }
    Cow::Owned(String::from_utf8_lossy(&bytes).into_owned())
}

/// A URI for messages.
pub(super) fn shown(uri: &str) -> String {
    const MOST: usize = 40;
    let mut text: String = uri
        .chars()
        .take(MOST)
        .map(|c| if c.is_control() { '\u{fffd}' } else { c })
        .collect();
    if uri.chars().nth(MOST).is_some() {
        text.push_str("...");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_decoded() {
        assert_eq!(decoded("a%20b%C3%A4.bin"), "a bä.bin");
        assert_eq!(decoded("100%.bin%2"), "100%.bin%2");
        assert_eq!(decoded("%ff"), "\u{fffd}");
        assert_eq!(
            data_uri("data:application/octet-stream;base64,AQID").map(|b| b[..3].to_vec()),
            Ok(vec![1, 2, 3])
        );
        assert_eq!(data_uri("data:;base64,AQ=="), Ok(vec![1, 0, 0, 0]));
        assert_eq!(data_uri("data:;base64,AQ"), data_uri("data:;base64,AQ=="));
        assert!(data_uri("data:,xyz").is_err());
    }
}
