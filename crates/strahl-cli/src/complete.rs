//! Whether a picture file is complete: `--resume` renders those again that are not.

use std::path::Path;
use strahl::formats::image::{ImageFormat, TextureUse, decode_texture, read_exr_header};

/// Whether a file holds a whole picture of this format and size. strahl renames complete pictures into place; other programs, and copies that
/// were interrupted, leave parts of files.
pub(crate) fn is_complete(file: &Path, format: ImageFormat, size: (u32, u32)) -> bool {
    if format == ImageFormat::Exr {
        // Its header, and its last rows.
        let header = read_exr_header(file).map(|header| header.window);
        return header.is_ok_and(|window| (window.width, window.height) == size);
    }
    let Ok(bytes) = std::fs::read(file) else {
        return false;
    };
    let found = match format {
        ImageFormat::Png => png(&bytes),
        ImageFormat::Jpeg => jpeg(&bytes),
        ImageFormat::Bmp => bmp(&bytes),
        ImageFormat::Tga => tga(&bytes),
        // Radiance pictures and pixmaps.
        _ => decoded(&bytes, file),
    };
    found == Some(size)
}

/// Two bytes, the low one first.
fn low_first(bytes: &[u8], at: usize) -> Option<u32> {
    let bytes = bytes.get(at..at + 2)?;
    Some(u16::from_le_bytes(bytes.try_into().ok()?).into())
}

/// Two bytes, the high one first.
fn high_first(bytes: &[u8], at: usize) -> Option<u32> {
    let bytes = bytes.get(at..at + 2)?;
    Some(u16::from_be_bytes(bytes.try_into().ok()?).into())
}

/// The size of a PNG file with an end (PNG specification 5.6).
fn png(bytes: &[u8]) -> Option<(u32, u32)> {
    let number = |at: usize| {
        let bytes = bytes.get(at..at + 4)?;
        Some(u32::from_be_bytes(bytes.try_into().ok()?))
    };
    let ends = bytes.len() >= 8 && bytes[bytes.len() - 8..].starts_with(b"IEND");
    let is_png = bytes.starts_with(b"\x89PNG\r\n\x1a\n") && ends;
    is_png.then_some((number(16)?, number(20)?))
}

/// The size of a JPEG file with an end: that of its frame header (ITU T.81, B.2.2).
fn jpeg(bytes: &[u8]) -> Option<(u32, u32)> {
    const START: &[u8] = &[0xff, 0xd8];
    const END: &[u8] = &[0xff, 0xd9];
    if !bytes.starts_with(START) || !bytes.ends_with(END) {
        return None;
    }
    let mut at = START.len();
    while let [0xff, marker] = *bytes.get(at..at + 2)? {
        // Frame headers are C0 to CF, but for the tables C4, C8 and CC.
        if matches!(marker, 0xc0..=0xcf) && !matches!(marker, 0xc4 | 0xc8 | 0xcc) {
            return Some((high_first(bytes, at + 7)?, high_first(bytes, at + 5)?));
        }
        at += 2 + high_first(bytes, at + 2)? as usize;
    }
    None
}

/// The size of a bitmap that has as many bytes as its header says.
fn bmp(bytes: &[u8]) -> Option<(u32, u32)> {
    let number = |at: usize| Some(low_first(bytes, at)? | low_first(bytes, at + 2)? << 16);
    let is_whole = bytes.starts_with(b"BM") && number(2)? as usize == bytes.len();
    // Rows from the top have a negative height.
    let height = number(22)?.cast_signed().unsigned_abs();
    is_whole.then_some((number(18)?, height))
}

/// The size of an uncompressed TGA file that has all its pixels.
fn tga(bytes: &[u8]) -> Option<(u32, u32)> {
    const HEADER: usize = 18;
    const TRUE_COLOR: u8 = 2;
    let (width, height) = (low_first(bytes, 12)?, low_first(bytes, 14)?);
    let bytes_per_pixel = usize::from(*bytes.get(16)?) / 8;
    let pixels = width as usize * height as usize * bytes_per_pixel;
    let length = HEADER + usize::from(bytes[0]) + pixels;
    (bytes[2] == TRUE_COLOR && bytes.len() >= length).then_some((width, height))
}

/// The size of a Radiance picture or a pixmap that can be decoded to its end; they begin with `#?` and `P`.
fn decoded(bytes: &[u8], file: &Path) -> Option<(u32, u32)> {
    if !bytes.starts_with(b"#?") && !bytes.starts_with(b"P") {
        return None;
    }
    let name = file.display().to_string();
    let picture = decode_texture(bytes, &name, TextureUse::Data).ok()?;
    Some((picture.width(), picture.height()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl::formats::image::{BitDepth, Picture, WriteOptions, encode_picture, formats};

    /// Every way to write a picture in a format.
    fn ways(format: ImageFormat) -> Vec<(WriteOptions, bool)> {
        let info = format.info();
        let mut ways = vec![];
        for bit_depth in [BitDepth::Eight, BitDepth::Sixteen] {
            for grayscale in [false, true] {
                for alpha in [false, true] {
                    if (grayscale && !info.grayscale) || (alpha && !info.alpha) {
                        continue;
                    }
                    let options = WriteOptions {
                        bit_depth,
                        grayscale,
                        ..WriteOptions::default()
                    };
                    ways.push((options, alpha));
                }
            }
        }
        ways
    }

    #[test]
    fn whole_pictures_of_the_size_are_complete() {
        let folder = tempfile::tempdir().unwrap();
        for (width, height) in [(9, 4), (1, 1)] {
            let count = width as usize * height as usize;
            let rgb: Vec<[f32; 3]> = (0..count).map(|i| [i as f32 / 300.0, 0.5, 2.0]).collect();
            let alpha = vec![0.5; count];
            for info in formats() {
                for (options, has_alpha) in ways(info.format) {
                    let picture = Picture {
                        alpha: has_alpha.then_some(&alpha),
                        metadata: vec![("scene".into(), "a 9 8 7.pov".into())],
                        ..Picture::new(width, height, &rgb)
                    };
                    let mut bytes = vec![];
                    encode_picture(&mut bytes, info.format, &picture, &options).unwrap();
                    let file = folder.path().join(format!("a.{}", info.extensions[0]));
                    let holds = |bytes: &[u8], size| {
                        std::fs::write(&file, bytes).unwrap();
                        is_complete(&file, info.format, size)
                    };
                    let name = info.name;
                    assert!(holds(&bytes, (width, height)), "{name} {options:?}");
                    assert!(!holds(&bytes, (width + 1, height)), "{name}");
                    assert!(!holds(&bytes, (width, height + 1)), "{name}");
                    let last = bytes.len().saturating_sub(12);
                    for length in (0..last).step_by(17).chain(last..bytes.len()) {
                        let part = &bytes[..length];
                        assert!(!holds(part, (width, height)), "{name}: {length} bytes");
                    }
                }
            }
        }
    }

    #[test]
    fn other_bytes_are_not_complete() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a");
        let garbage: Vec<u8> = (0..4000u32)
            .map(|i| (i.wrapping_mul(2_654_435) >> 8) as u8)
            .collect();
        for bytes in [
            &garbage[..],
            b"P6",
            b"P6 4294967295 4294967295 65535 ",
            b"\xff\xd8\xff\xe0\0\0\xff\xd9",
        ] {
            std::fs::write(&file, bytes).unwrap();
            for info in formats() {
                assert!(!is_complete(&file, info.format, (8, 6)), "{}", info.name);
            }
        }
        assert!(!is_complete(folder.path(), ImageFormat::Png, (8, 6)));
    }
}
