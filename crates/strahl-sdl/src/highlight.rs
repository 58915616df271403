//! The kinds of the pieces of a text, for colouring it.

use crate::keywords::WordKind;
use crate::lexer::{Lexed, lex, token_length};
use crate::source::Part;
use crate::symbol::Symbols;
use crate::token::{Kind, Token};

/// The kind of a piece of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Piece {
    /// Blanks, and whatever has no kind of its own.
    Plain,
    /// A comment.
    Comment,
    /// `#` with its word.
    Directive,
    /// A number.
    Number,
    /// A string with its quotation marks.
    String,
    /// A reserved word that opens an object: `sphere`.
    Object,
    /// A reserved word that opens something else: `pigment`, `camera`.
    Block,
    /// A built-in function, or a number or vector with a fixed name: `sin`, `pi`, `x`.
    Function,
    /// Any other reserved word.
    Word,
    /// A name of the scene's own.
    Name,
    /// Operators, brackets, commas.
    Sign,
}

/// Cuts a text into pieces: each with its length in bytes. The lengths add up to that of the text. Any text is accepted, of less than 4 GiB.
///
/// ```
/// use strahl_sdl::{Piece, highlight};
///
/// let pieces = highlight("sphere { 0, 1 } // a ball");
/// assert_eq!(pieces[0], (6, Piece::Object));
/// assert_eq!(pieces.last(), Some(&(9, Piece::Comment)));
/// ```
pub fn highlight(text: &str) -> Vec<(usize, Piece)> {
    let bytes = text.as_bytes();
    let part = Part {
        bytes,
        begin: 0,
        is_last: true,
    };
    let (mut symbols, mut pieces) = (Symbols::new(), Pieces::default());
    let (mut lexed, mut begin, mut at) = (Lexed::default(), 0, 0);
    loop {
        lexed = lex(&part, begin, usize::MAX, &mut symbols, lexed);
        for token in &lexed.tokens {
            if token.kind == Kind::End {
                continue;
            }
            let start = token.start as usize;
            if start < at || start >= bytes.len() {
                continue;
            }
            pieces.gap(&bytes[at..start]);
            let mut length = length(token.kind, &bytes[start..]);
            while !text.is_char_boundary(start + length) {
                length += 1;
            }
            pieces.push(length, kind(*token));
            at = start + length;
        }
        match lexed.rest {
            Some(rest) if rest > begin => begin = rest,
            _ => break,
        }
    }
    pieces.gap(&bytes[at..]);
    pieces.0
}

/// Pieces under construction; equal neighbours are one.
#[derive(Default)]
struct Pieces(Vec<(usize, Piece)>);

impl Pieces {
    fn push(&mut self, length: usize, piece: Piece) {
        match self.0.last_mut() {
            _ if length == 0 => {}
            Some((known, kind)) if *kind == piece => *known += length,
            _ => self.0.push((length, piece)),
        }
    }

    /// What the lexer has left out: blanks and comments.
    fn gap(&mut self, mut bytes: &[u8]) {
        while !bytes.is_empty() {
            let comment = bytes.starts_with(b"//") || bytes.starts_with(b"/*");
            let length = if bytes.starts_with(b"//") {
                bytes.iter().position(|b| *b == b'\n')
            } else if comment {
                end_of_block(bytes)
            } else {
                let starts = |at: &usize| matches!(bytes.get(*at..*at + 2), Some(b"//" | b"/*"));
                (1..bytes.len()).find(starts)
            };
            let length = length.unwrap_or(bytes.len());
            let piece = if comment {
                Piece::Comment
            } else {
                Piece::Plain
            };
            self.push(length, piece);
            bytes = &bytes[length..];
        }
    }
}

/// The length of a comment in `/* */`, which may have others within.
fn end_of_block(bytes: &[u8]) -> Option<usize> {
    let (mut at, mut depth) = (0, 0usize);
    while at + 1 < bytes.len() {
        match &bytes[at..at + 2] {
            b"/*" => (depth, at) = (depth + 1, at + 2),
            b"*/" if depth == 1 => return Some(at + 2),
            b"*/" => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
    }
    None
}

/// The length of a token at the beginning of `rest`.
fn length(kind: Kind, rest: &[u8]) -> usize {
    let length = match kind {
        Kind::String => {
            let mut at = 1;
            while at < rest.len() && rest[at] != b'"' {
                at += if rest[at] == b'\\' { 2 } else { 1 };
            }
            at + 1
        }
        Kind::Unknown => {
            let more = rest[1..].iter().take_while(|b| (**b & 0xc0) == 0x80);
            1 + more.count()
        }
        _ => token_length(rest),
    };
    length.clamp(1, rest.len())
}

fn kind(token: Token) -> Piece {
    match token.kind {
        Kind::Number => Piece::Number,
        Kind::String => Piece::String,
        Kind::Directive => Piece::Directive,
        Kind::Name => Piece::Name,
        Kind::Unknown => Piece::Plain,
        Kind::Word => match token.word().map(|word| word.kind()) {
            Some(WordKind::Object) => Piece::Object,
            Some(WordKind::Statement | WordKind::Thing) => Piece::Block,
            Some(
                WordKind::FloatFunction
                | WordKind::VectorFunction
                | WordKind::StringFunction
                | WordKind::Constant,
            ) => Piece::Function,
            _ => Piece::Word,
        },
        _ => Piece::Sign,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    fn shown(text: &str) -> Vec<(&str, Piece)> {
        let (mut at, mut out) = (0, vec![]);
        for (length, piece) in highlight(text) {
            out.push((&text[at..at + length], piece));
            at += length;
        }
        assert_eq!(at, text.len());
        out
    }

    #[test]
    fn a_scene_is_cut_into_coloured_pieces() {
        let text =
            "/* a /* b */ c */ #declare R = \"a\\\"b\"; // end\nsphere{<0,1.5,x>R pigment{Red}}";
        let pieces = shown(text);
        for expected in [
            ("/* a /* b */ c */", Piece::Comment),
            ("#declare", Piece::Directive),
            ("R", Piece::Name),
            ("\"a\\\"b\"", Piece::String),
            ("// end", Piece::Comment),
            ("sphere", Piece::Object),
            ("1.5", Piece::Number),
            ("x", Piece::Function),
            ("pigment", Piece::Block),
            ("Red", Piece::Name),
        ] {
            assert!(pieces.contains(&expected), "{expected:?} in {pieces:?}");
        }
    }

    #[test]
    fn unfinished_texts_are_cut_too() {
        for text in [
            "",
            "\"abc",
            "/* abc",
            "#",
            "\u{feff}sphere",
            "\"a\\",
            "ä ö €",
            "#if(1) ",
        ] {
            shown(text);
        }
    }

    #[test]
    fn the_pieces_of_any_text_make_it_up() {
        let letters: Vec<char> = "\"/*#\\<aß1. \n€{".chars().collect();
        let mut state = 1u64;
        for _ in 0..20_000 {
            let mut text = String::new();
            for _ in 0..12 {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1);
                text.push(letters[(state >> 33) as usize % letters.len()]);
            }
            shown(&text);
        }
    }
}
