//! Files: who reads and writes them, and what is kept of those read.

use crate::lexer::{self, Lexed};
use crate::symbol::Symbols;
use crate::token::Token;
use std::io::Write;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use strahl_scene::{Diagnostic, FileId, SourceLine, Span};

mod folder;
mod fonts;
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

impl HostError {
    /// Adds folders that were searched as well.
    pub(crate) fn also(mut self, more: Vec<String>) -> Self {
        if let Self::NotFound { searched, .. } = &mut self {
            searched.extend(more);
        }
        self
    }
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

    /// Reads a font of the system by the name of its file, without folder; `None` if there is none. Scenes that name a font get
    /// here when [`Host::load`] does not find it.
    ///
    /// # Errors
    /// If the file is there and can't be read.
    fn load_font(&mut self, _file: &str) -> Result<Option<Source>, HostError> {
        Ok(None)
    }

    /// Reads a file that is neither where [`Host::load`] looks nor built in, such as a picture of an installed POV-Ray.
    ///
    /// # Errors
    /// [`HostError::NotFound`] where nothing of the kind is known.
    fn load_installed(&mut self, name: &str) -> Result<Source, HostError> {
        Err(HostError::NotFound {
            name: name.to_owned(),
            searched: vec![],
        })
    }

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

/// The text of a file.
#[derive(Debug)]
pub(crate) struct SourceFile {
    pub(crate) id: FileId,
    pub(crate) name: String,
    pub(crate) bytes: Vec<u8>,
    /// Where the lines begin; made when first needed.
    lines: OnceLock<Vec<u32>>,
    /// The place looked up last.
    last: Mutex<Line>,
}

/// The line that a place stands in.
#[derive(Clone, Copy, Debug, Default)]
struct Line {
    /// The place.
    at: u32,
    /// How many lines end before it.
    ends: u32,
    /// Where its line begins.
    begin: u32,
}

impl SourceFile {
    /// `source` must be shorter than 4 GiB.
    pub(crate) fn new(id: FileId, source: Source) -> Self {
        Self {
            id,
            name: source.name,
            bytes: source.bytes,
            lines: OnceLock::new(),
            last: Mutex::default(),
        }
    }

    fn lines(&self) -> &[u32] {
        self.lines.get_or_init(|| {
            let mut starts = vec![0];
            let ends = self.bytes.iter().enumerate().filter(|(_, b)| **b == b'\n');
            starts.extend(ends.map(|(at, _)| at as u32 + 1));
            starts
        })
    }

    /// The line that a byte offset stands in.
    ///
    /// Most places asked for stand behind the one before, and going on from there needs no table of all lines, which takes
    /// a pass over the file and a search that misses the cache at every step.
    fn line_of(&self, start: u32) -> Line {
        const NEAR: u32 = 4096;
        const FAR: u32 = 1 << 20;
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let far = if self.lines.get().is_none() {
            FAR
        } else {
            NEAR
        };
        let passed = self.bytes.get(last.at as usize..start as usize);
        match passed {
            Some(passed) if passed.len() <= far as usize => {
                let ends = memchr::memchr_iter(b'\n', passed).count() as u32;
                if let Some(end) = memchr::memrchr(b'\n', passed) {
                    last.begin = last.at + end as u32 + 1;
                }
                last.ends += ends;
            }
            // Back within the line.
            None if start >= last.begin => {}
            _ => {
                let lines = self.lines();
                last.ends = lines.partition_point(|s| *s <= start).saturating_sub(1) as u32;
                last.begin = lines.get(last.ends as usize).copied().unwrap_or(0);
            }
        }
        last.at = start;
        *last
    }

    /// The place of the token at a byte offset.
    pub(crate) fn span(&self, start: u32) -> Span {
        /// Beyond this many bytes into a line, columns are counted in bytes: exporters write whole scenes into one line.
        const COUNTED: usize = 4096;
        // The place may be one behind the last byte.
        let start = start.min(self.bytes.len() as u32);
        let line = self.line_of(start);
        let before = self.bytes.get(line.begin as usize..start as usize);
        let before = before.unwrap_or(&[]);
        let column = if before.len() > COUNTED {
            before.len()
        } else {
            // Continuation bytes of UTF-8 are no characters of their own.
            before.iter().filter(|b| **b & 0xc0 != 0x80).count()
        };
        Span {
            file: self.id,
            line: line.ends + 1,
            column: column as u32 + 1,
            length: lexer::token_length(&self.bytes, start as usize) as u32,
        }
    }

    /// The line that a span of this file points into; of a very long one, as exporters write them, what stands around the
    /// place.
    pub(crate) fn excerpt(&self, start: u32, span: Span) -> SourceLine {
        const AROUND: usize = 80;
        let line = self.line_bytes(span.line);
        if line.len() <= 4096 {
            let shown = Diagnostic::error("").at(span);
            let shown = shown.with_source(&self.name, &lexer::decode(line));
            return shown.source.unwrap_or_else(|| SourceLine {
                file: self.name.clone(),
                text: String::new(),
                column: 1,
                length: 1,
            });
        }
        let place = (start as usize).min(self.bytes.len());
        let piece = |from: usize, to: usize| {
            let bytes = self.bytes.get(from..to).unwrap_or(&[]);
            bytes
                .split(|b| *b == b'\n')
                .map(lexer::decode)
                .collect::<Vec<_>>()
        };
        let before = piece(place.saturating_sub(AROUND), place)
            .pop()
            .unwrap_or_default();
        let end = (place + AROUND).min(self.bytes.len());
        let behind = piece(place, end).into_iter().next().unwrap_or_default();
        let length = (behind.chars().count() as u32).clamp(1, span.length.max(1));
        SourceLine {
            file: self.name.clone(),
            column: before.chars().count() as u32 + 1,
            text: before + &behind,
            length,
        }
    }

    /// The text of a line, counted from 1.
    #[cfg(test)]
    pub(crate) fn line_text(&self, line: u32) -> String {
        lexer::decode(self.line_bytes(line))
    }

    fn line_bytes(&self, line: u32) -> &[u8] {
        let lines = self.lines();
        let index = (line as usize).saturating_sub(1);
        let begin = lines.get(index).map_or(self.bytes.len(), |s| *s as usize);
        let end = lines
            .get(index + 1)
            .map_or(self.bytes.len(), |s| *s as usize - 1);
        let text = self.bytes.get(begin..end).unwrap_or(&[]);
        text.strip_suffix(b"\r").unwrap_or(text)
    }

    /// The text between the quotation marks of a string, escapes left alone: file names of Windows need it.
    pub(crate) fn raw_string(&self, token: Token) -> String {
        let rest = self.bytes.get(token.start as usize + 1..).unwrap_or(&[]);
        let end = rest.iter().position(|b| *b == b'"').unwrap_or(rest.len());
        lexer::decode(&rest[..end])
    }
}

/// The tokens of a part of a file that nothing reaches into or out of; most files are one chunk.
#[derive(Debug)]
pub(crate) struct Chunk {
    pub(crate) source: Arc<SourceFile>,
    /// That of the source.
    pub(crate) file: FileId,
    pub(crate) lexed: Lexed,
}

impl Chunk {
    /// How many tokens a chunk has at least, unless the file ends before: with 16 bytes each they fit into the second
    /// level of caches.
    pub(crate) const TOKENS: usize = 8192;

    /// The first chunk of a file, of so many tokens.
    pub(crate) fn first(source: Arc<SourceFile>, tokens: usize, symbols: &mut Symbols) -> Self {
        // Measured on exported scenes: three to five bytes per token.
        let capacity = (source.bytes.len() / 3 + 16).min(tokens.saturating_add(tokens / 8));
        let space = Lexed {
            tokens: Vec::with_capacity(capacity),
            ..Lexed::default()
        };
        Self {
            file: source.id,
            lexed: lexer::lex(&source.bytes, 0, tokens, symbols, space),
            source,
        }
    }

    /// The chunk behind `this`, which takes its memory if nobody else needs it; `false` at the end of the file.
    pub(crate) fn advance(this: &mut Arc<Self>, symbols: &mut Symbols) -> bool {
        let Some(begin) = this.lexed.rest else {
            return false;
        };
        let used = Arc::get_mut(this).map(|own| std::mem::take(&mut own.lexed));
        let source = Arc::clone(&this.source);
        let lexed = lexer::lex(
            &source.bytes,
            begin,
            Self::TOKENS,
            symbols,
            used.unwrap_or_default(),
        );
        match Arc::get_mut(this) {
            Some(own) => own.lexed = lexed,
            None => {
                let file = source.id;
                *this = Arc::new(Self {
                    source,
                    file,
                    lexed,
                });
            }
        }
        true
    }

    /// The token at an index.
    #[inline]
    pub(crate) fn token(&self, index: usize) -> Option<Token> {
        self.lexed.tokens.get(index).copied()
    }

    /// The tokens from an index on.
    #[inline]
    pub(crate) fn tokens_from(&self, index: usize) -> &[Token] {
        self.lexed.tokens.get(index..).unwrap_or(&[])
    }

    /// Index of the last token, [`Kind::End`](crate::Kind::End).
    pub(crate) fn end(&self) -> usize {
        self.lexed.tokens.len().saturating_sub(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::token::Kind;

    #[test]
    fn places_are_lines_and_characters() {
        let text = "sphere\n  \u{e9}\u{e9} box{\r\n";
        let source = Source::new("a.pov", text);
        let file = SourceFile::new(FileId(3), source);
        let start = text.find("box").unwrap() as u32;
        let span = file.span(start);
        assert_eq!((span.line, span.column, span.length), (2, 6, 3));
        assert_eq!(file.line_text(2), "  \u{e9}\u{e9} box{");
        assert_eq!(file.line_text(9), "");
    }

    #[test]
    fn places_do_not_depend_on_those_asked_for_before() {
        let mut text = String::new();
        for line in 0..3000 {
            let width = if line % 1000 == 7 { 9000 } else { line % 50 };
            text.push_str(&"x".repeat(width));
            text.push('\n');
        }
        let place = |start: usize| {
            let line = text[..start].matches('\n').count();
            let begin = text[..start].rfind('\n').map_or(0, |at| at + 1);
            (line as u32 + 1, (start - begin) as u32 + 1)
        };
        for with_table in [false, true] {
            let file = SourceFile::new(FileId(0), Source::new("a.pov", text.clone()));
            if with_table {
                file.lines();
            }
            let mut state = 1usize;
            for round in 0..2000 {
                state = state.wrapping_mul(1_103_515_245).wrapping_add(12_345) % (1 << 31);
                let near = if round % 3 == 0 { text.len() } else { 5000 };
                let start = (state % near + round * 40) % (text.len() + 1);
                let span = file.span(start as u32);
                assert_eq!((span.line, span.column), place(start), "{start}");
            }
        }
    }

    #[test]
    fn chunks_follow_each_other_without_a_gap() {
        let object = "sphere { <1, 2, 3>, 4 pigment { rgb <0, 1, 0> } } // a\n";
        let mut text = object.repeat(2000);
        text.push_str("mesh2 { vertex_vectors { 9999");
        text.push_str(&", <1, 2, 3>".repeat(9999));
        text.push_str("} } #if (1)");
        text.push_str(&object.repeat(2000));
        text.push_str("#end box { 1, \"end\" }");
        let mut symbols = Symbols::new();
        let source = Arc::new(SourceFile::new(FileId(0), Source::new("a.pov", text)));
        let whole = Chunk::first(Arc::clone(&source), usize::MAX, &mut symbols);
        let mut chunk = Arc::new(Chunk::first(source, Chunk::TOKENS, &mut symbols));
        let first = Arc::clone(&chunk);
        let (mut tokens, mut lengths) = (vec![], vec![]);
        loop {
            assert_eq!(chunk.token(chunk.end()).unwrap().kind, Kind::End);
            tokens.extend((0..chunk.end()).filter_map(|i| chunk.token(i)));
            lengths.push(chunk.end());
            if !Chunk::advance(&mut chunk, &mut symbols) {
                break;
            }
        }
        assert_eq!(first.end(), lengths[0]);
        let short = lengths.iter().take(lengths.len() - 1);
        assert!(
            short.into_iter().all(|n| *n < Chunk::TOKENS + 50),
            "{lengths:?}"
        );
        assert!(lengths.len() > 5);
        // Links are indices within the chunk.
        for (a, b) in tokens.iter().zip(&whole.lexed.tokens) {
            assert_eq!((a.kind, a.start), (b.kind, b.start));
        }
        assert_eq!(tokens.len(), whole.end());
    }
}
