//! What a file is by its first bytes, to say it where something else was expected.

use super::text::without_mark;

/// A kind of file that is often given for another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Kind {
    /// What it is, with its article.
    pub(crate) what: &'static str,
    /// What to do with it.
    pub(crate) advice: Advice,
}

/// What to do with a file that is something else.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Advice {
    Nothing,
    /// What is wanted is within.
    Unpack,
    /// A page of the web that was saved instead of the file, or a stand-in for it.
    Fetch,
    /// A program has to write it in another format.
    Export,
    /// A scene of this format.
    Scene(&'static str),
}

impl Advice {
    /// The same in words.
    pub(crate) fn hint(self) -> Option<String> {
        Some(match self {
            Self::Nothing => return None,
            Self::Unpack => "unpack it first".into(),
            Self::Fetch => "it stands in the place of the file: download the file itself".into(),
            Self::Export => {
                "save it as glTF, OBJ, PLY or STL with the program that wrote it".into()
            }
            Self::Scene(format) => format!("read it with `--scene-format {format}`"),
        })
    }
}

/// Kinds by the first bytes that all files of them have.
const KINDS: &[(&[u8], &str, Advice)] = {
    use Advice::{Export, Fetch, Nothing, Scene, Unpack};
    &[
        (b"\x89PNG\r\n\x1a\n", "a PNG picture", Nothing),
        (b"\xff\xd8\xff", "a JPEG picture", Nothing),
        (b"GIF87a", "a GIF picture", Nothing),
        (b"GIF89a", "a GIF picture", Nothing),
        (b"II*\0", "a TIFF picture", Nothing),
        (b"MM\0*", "a TIFF picture", Nothing),
        (b"v/1\x01", "an OpenEXR picture", Nothing),
        (b"#?RADIANCE", "a Radiance HDR picture", Nothing),
        (b"8BPS", "a Photoshop picture", Nothing),
        (b"DDS ", "a DDS picture", Nothing),
        (b"\xabKTX ", "a KTX texture", Nothing),
        (b"PK\x03\x04", "a ZIP archive", Unpack),
        (b"Rar!\x1a\x07", "a RAR archive", Unpack),
        (b"7z\xbc\xaf\x27\x1c", "a 7z archive", Unpack),
        (b"\x1f\x8b", "gzip data", Unpack),
        (b"BZh", "bzip2 data", Unpack),
        (b"\xfd7zXZ\0", "xz data", Unpack),
        (b"\x28\xb5\x2f\xfd", "Zstandard data", Unpack),
        (b"%PDF-", "a PDF document", Nothing),
        (b"\x7fELF", "a program", Nothing),
        (b"wOFF", "a font", Nothing),
        (b"wOF2", "a font", Nothing),
        (b"OTTO", "a font", Nothing),
        (b"<!DOCTYPE html", "an HTML page", Fetch),
        (b"<!doctype html", "an HTML page", Fetch),
        (b"<html", "an HTML page", Fetch),
        (b"version https://git-lfs", "a pointer of Git LFS", Fetch),
        (b"BLENDER", "a Blender file", Export),
        (b"Kaydara FBX Binary", "an FBX file", Export),
        (b"PXR-USDC", "a USD file", Export),
        (b"#usda ", "a USD file", Export),
        (b"ISO-10303-21", "a STEP file", Export),
        (b"glTF", "a binary glTF file", Scene("gltf")),
        (b"ply\n", "a PLY file", Scene("ply")),
        (b"ply\r", "a PLY file", Scene("ply")),
    ]
};

/// What a file is, if its first bytes show it.
pub(crate) fn kind(bytes: &[u8]) -> Option<Kind> {
    let text = without_mark(bytes);
    let plain = KINDS.iter().find(|(magic, ..)| text.starts_with(magic));
    if let Some((_, what, advice)) = plain {
        let (what, advice) = (*what, *advice);
        return Some(Kind { what, advice });
    }
    let what = match bytes {
        [
            b'R',
            b'I',
            b'F',
            b'F',
            _,
            _,
            _,
            _,
            b'W',
            b'E',
            b'B',
            b'P',
            ..,
        ] => "a WebP picture",
        // Two letters alone may be words of a text: BMP has zeros, too.
        [b'B', b'M', _, _, _, _, 0, 0, 0, 0, ..] => "a BMP picture",
        _ => return None,
    };
    let advice = Advice::Nothing;
    Some(Kind { what, advice })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_told_by_their_first_bytes() {
        let what = |bytes: &[u8]| kind(bytes).map(|kind| kind.what);
        for (magic, expected, _) in KINDS {
            assert_eq!(what(&[magic, &b"and more"[..]].concat()), Some(*expected));
            assert_eq!(what(&magic[..magic.len() - 1]), None, "{expected}");
        }
        assert_eq!(what(b"RIFF\x10\0\0\0WEBPVP8 "), Some("a WebP picture"));
        assert_eq!(what(b"RIFF\x10\0\0\0WAVEfmt "), None);
        assert_eq!(what(b"BM\x10\0\0\0\0\0\0\0"), Some("a BMP picture"));
        assert_eq!(what(b"BM 1 2 3 4 5"), None);
        assert_eq!(what(b"\xef\xbb\xbf<html>"), Some("an HTML page"));
        for text in [
            "",
            "v 1 2 3",
            "solid a",
            "{\"asset\": {}}",
            "b 0 0 0",
            "ply",
        ] {
            assert_eq!(what(text.as_bytes()), None, "{text}");
        }
    }
}
