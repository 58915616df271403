//! Files: who reads and writes them, and what is kept of those read.

use crate::lexer::{self, LexProblem};
use crate::symbol::Symbols;
use crate::token::Token;
use std::io::Write;
use std::sync::{Arc, OnceLock};
use strahl_scene::{FileId, Span};

mod folder;
mod memory;

pub use folder::FolderHost;
pub use memory::MemoryHost;

/// A scene file to be parsed.
#[derive(Clone, Debug)]
pub struct Source {
    /// Its name as shown to the user; includes are searched beside it first.
    pub name: String,
    /// Its text: UTF-8 or Latin-1.
    pub bytes: Vec<u8>,
}

impl Source {
    /// A scene from a text in memory.
    pub fn new(name: impl Into<String>, text: impl Into<Vec<u8>>) -> Self {
        Self {
            name: name.into(),
            bytes: text.into(),
        }
    }
}

/// Where a message of the scene goes: the directives of these names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stream {
    /// `#debug`
    Debug,
    /// `#render`
    Render,
    /// `#statistics`
    Statistics,
    /// `#warning`; also reported as a diagnostic.
    Warning,
}

/// Why a file could not be read or written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum HostError {
    /// There is no such file.
    #[error("there is no file `{name}`")]
    NotFound {
        /// The name asked for.
        name: String,
        /// Where it was searched, in order.
        searched: Vec<String>,
    },
    /// The file is larger than the limit.
    #[error("`{name}` is larger than {limit} bytes")]
    TooLarge {
        /// The file.
        name: String,
        /// The limit.
        limit: u64,
    },
    /// The place is outside of the folders where scenes may write.
    #[error("a scene may not write `{name}`: {why}")]
    Forbidden {
        /// The file.
        name: String,
        /// Which rule says so.
        why: String,
    },
    /// The system says no.
    #[error("`{name}`: {message}")]
    Io {
        /// The file.
        name: String,
        /// The system's words.
        message: String,
    },
}

/// What the parser asks of the world outside: it does no input or output by itself.
pub trait Host: Send {
    /// Reads a file that a scene names.
    ///
    /// `from` is the name (as returned by this function, or of the scene) of the file that asks.
    ///
    /// # Errors
    /// [`HostError::NotFound`] lets the parser look among the built-in include files.
    fn load(&mut self, name: &str, from: &str) -> Result<Source, HostError>;

    /// Opens a file for `#write`.
    ///
    /// # Errors
    /// If the place is not allowed or the system refuses.
    fn create(&mut self, name: &str, append: bool) -> Result<Box<dyn Write + Send>, HostError>;

    /// Takes a message of the scene.
    fn message(&mut self, stream: Stream, text: &str);

    /// Days since the beginning of 2000 in UTC, the value of `now`; a fixed time makes scenes reproducible.
    fn now(&mut self) -> f64;
}

/// A file with its tokens.
#[derive(Debug)]
pub(crate) struct SourceFile {
    pub(crate) id: FileId,
    pub(crate) name: String,
    pub(crate) bytes: Vec<u8>,
    pub(crate) tokens: Vec<Token>,
    pub(crate) strings: Vec<Arc<str>>,
    lines: OnceLock<Vec<u32>>,
}

impl SourceFile {
    /// Cuts a text into tokens; `bytes` must be shorter than 4 GiB.
    pub(crate) fn new(
        id: FileId,
        source: Source,
        symbols: &mut Symbols,
    ) -> (Self, Vec<LexProblem>) {
        let lexed = lexer::lex(&source.bytes, symbols);
        let file = Self {
            id,
            name: source.name,
            bytes: source.bytes,
            tokens: lexed.tokens,
            strings: lexed.strings,
            lines: OnceLock::new(),
        };
        (file, lexed.problems)
    }

    fn lines(&self) -> &[u32] {
        self.lines.get_or_init(|| {
            let mut starts = vec![0];
            let ends = self.bytes.iter().enumerate().filter(|(_, b)| **b == b'\n');
            starts.extend(ends.map(|(at, _)| at as u32 + 1));
            starts
        })
    }

    /// The place of the token at a byte offset.
    pub(crate) fn span(&self, start: u32) -> Span {
        /// Beyond this many bytes into a line, columns are counted in bytes: exporters write whole scenes into one line.
        const COUNTED: usize = 4096;
        let lines = self.lines();
        let line = lines.partition_point(|s| *s <= start);
        let begin = lines.get(line.saturating_sub(1)).copied().unwrap_or(0) as usize;
        let before = self.bytes.get(begin..start as usize).unwrap_or(&[]);
        let column = if before.len() > COUNTED {
            before.len()
        } else {
            // Continuation bytes of UTF-8 are no characters of their own.
            before.iter().filter(|b| **b & 0xc0 != 0x80).count()
        };
        Span {
            file: self.id,
            line: line as u32,
            column: column as u32 + 1,
            length: lexer::token_length(&self.bytes, start as usize) as u32,
        }
    }

    /// The text of a line, counted from 1.
    pub(crate) fn line_text(&self, line: u32) -> String {
        let lines = self.lines();
        let index = (line as usize).saturating_sub(1);
        let begin = lines.get(index).map_or(self.bytes.len(), |s| *s as usize);
        let end = lines
            .get(index + 1)
            .map_or(self.bytes.len(), |s| *s as usize - 1);
        let text = self.bytes.get(begin..end).unwrap_or(&[]);
        lexer::decode(text.strip_suffix(b"\r").unwrap_or(text))
    }

    /// The text between the quotation marks of a string, escapes left alone: file names of Windows need it.
    pub(crate) fn raw_string(&self, token: Token) -> String {
        let rest = self.bytes.get(token.start as usize + 1..).unwrap_or(&[]);
        let end = rest.iter().position(|b| *b == b'"').unwrap_or(rest.len());
        lexer::decode(&rest[..end])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_lines_and_characters() {
        let text = "sphere\n  \u{e9}\u{e9} box{\r\n";
        let source = Source::new("a.pov", text);
        let (file, _) = SourceFile::new(FileId(3), source, &mut Symbols::new());
        let start = text.find("box").unwrap() as u32;
        let span = file.span(start);
        assert_eq!((span.line, span.column, span.length), (2, 6, 3));
        assert_eq!(file.line_text(2), "  \u{e9}\u{e9} box{");
        assert_eq!(file.line_text(9), "");
    }
}
