//! The texts of a scene's files, cut into pieces for colouring.

use crate::protocol::LONGEST_TEXT;
use serde::Serialize;
use std::path::Path;
use strahl::sdl::{Piece, highlight};

/// A text of a scene, cut into pieces for colouring.
#[derive(Clone, Debug, Serialize)]
pub struct Text {
    /// The text.
    pub text: String,
    /// Length (in UTF-16 units, as JavaScript counts) and kind of each piece, one after the other.
    pub pieces: Vec<u32>,
}

impl Text {
    /// A text; `is_sdl` says whether it is in the scene language.
    pub fn new(text: String, is_sdl: bool) -> Self {
        let pieces = match is_sdl {
            true => pieces(&text),
            false => vec![],
        };
        Self { text, pieces }
    }

    /// Reads a text file.
    ///
    /// # Errors
    /// There is no such file, it is no text, or it has more than 1 MiB.
    pub fn read(path: &Path) -> Result<Self, String> {
        let size = std::fs::metadata(path).map_err(|e| e.to_string())?.len();
        if size > LONGEST_TEXT as u64 {
            return Err(format!(
                "it has {size} bytes; texts up to {LONGEST_TEXT} bytes are shown"
            ));
        }
        let bytes = std::fs::read(path).map_err(|e| e.to_string())?;
        if bytes.contains(&0) {
            return Err("it is not a text".into());
        }
        let text = match String::from_utf8(bytes) {
            Ok(text) => text,
            // As the parser reads it.
            Err(other) => other.as_bytes().iter().map(|b| char::from(*b)).collect(),
        };
        Ok(Self::new(text, is_sdl(path)))
    }
}

/// Whether a file is in the scene language, judging by its name.
pub(crate) fn is_sdl(path: &Path) -> bool {
    let ending = path.extension().map(|e| e.to_ascii_lowercase());
    !ending.is_some_and(|e| {
        ["nff", "obj", "mtl", "ply", "stl", "gltf"]
            .iter()
            .any(|other| e == *other)
    })
}

/// Length in UTF-16 units and kind of each piece of a text.
pub(crate) fn pieces(text: &str) -> Vec<u32> {
    let mut at = 0;
    let mut all = vec![];
    for (length, piece) in highlight(text) {
        let part = text.get(at..at + length).unwrap_or("");
        at += length;
        let kind = match piece {
            Piece::Plain => 0,
            Piece::Comment => 1,
            Piece::Directive => 2,
            Piece::Number => 3,
            Piece::String => 4,
            Piece::Object => 5,
            Piece::Block => 6,
            Piece::Function => 7,
            Piece::Word => 8,
            Piece::Name => 9,
            Piece::Sign => 10,
        };
        all.extend([part.encode_utf16().count() as u32, kind]);
    }
    all
}

/// Whether a text uses `clock`, not counting comments and strings.
pub(crate) fn names_clock(text: &str) -> bool {
    let mut at = 0;
    text.contains("clock")
        && highlight(text).into_iter().any(|(length, piece)| {
            let part = text.get(at..at + length);
            at += length;
            part == Some("clock") && !matches!(piece, Piece::Comment | Piece::String)
        })
}

#[cfg(test)]
mod tests {
    #[test]
    fn clock_counts_where_it_is_code() {
        assert!(names_clock("sphere { clock*x, 1 }") && names_clock("rotate clock"));
        assert!(!names_clock(
            "// clock\nsphere { clocks, 1 } #debug \"clock\""
        ));
    }

    use super::*;

    #[test]
    fn pieces_count_as_javascript_does() {
        let pieces = pieces("/* 𝄞ä */ sphere");
        assert_eq!(pieces, [9, 1, 1, 0, 6, 5]);
    }

    #[test]
    fn binary_and_huge_files_are_not_shown() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.pov");
        std::fs::write(&path, [0, 1, 2]).unwrap();
        assert!(Text::read(&path).is_err());
        std::fs::write(&path, vec![b' '; LONGEST_TEXT + 1]).unwrap();
        assert!(Text::read(&path).is_err_and(|e| e.contains("bytes")));
        std::fs::write(&path, b"// \xe4").unwrap();
        assert_eq!(Text::read(&path).unwrap().text, "// ä");
    }
}
