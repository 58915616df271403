//! Bytes to tokens, a chunk of the file at a time.
//!
//! The lexer also links the directives of each block (`#if` to `#else` to `#end`), so that skipping a branch or jumping back to
//! the head of a loop takes no search.
//!
//! A chunk of a long file ends where no block, parenthesis or bracket is open, and only before a word that opens an object or
//! between two vectors of a list. At these positions the next token is only read through [`Parser::peek`](crate::Parser::peek),
//! which continues with the next chunk. So there are no jumps from one chunk into another, and the tokens of an exported scene
//! of any size stay in the processor's cache.

mod number;
#[cfg(test)]
mod tests;
mod text;

pub(crate) use text::decode;

use crate::keywords::{Word, WordKind};
use crate::source::Part;
use crate::symbol::{Symbol, Symbols};
use crate::token::{Directive, Kind, Token};
use std::sync::Arc;

/// An error in the text itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct LexProblem {
    /// Byte offset.
    pub(crate) start: u32,
    /// The error.
    pub(crate) message: String,
    /// The advice.
    pub(crate) hint: &'static str,
}

/// The tokens of a chunk of a file; the last one is [`Kind::End`].
#[derive(Debug, Default)]
pub(crate) struct Lexed {
    pub(crate) tokens: Vec<Token>,
    pub(crate) strings: Vec<Arc<str>>,
    pub(crate) problems: Vec<LexProblem>,
    /// Byte offset at which the next chunk begins; `None` at the end of the file.
    pub(crate) rest: Option<usize>,
    /// Whether the given part of the text ends within the chunk, in which case the chunk is unusable.
    pub(crate) is_cut: bool,
}

/// Splits a part of a text into tokens, from a byte offset (of the file) up to the first position after `wanted` tokens where a
/// chunk may end. The text must be shorter than 4 GiB, which the source loader ensures.
///
/// The vectors of `used` are reused.
pub(crate) fn lex(
    part: &Part<'_>,
    begin: usize,
    wanted: usize,
    symbols: &mut Symbols,
    used: Lexed,
) -> Lexed {
    let mut out = used;
    out.tokens.clear();
    out.strings.clear();
    out.problems.clear();
    out.rest = None;
    out.is_cut = false;
    let mut lexer = Lexer {
        bytes: part.bytes,
        base: part.begin,
        is_last: part.is_last,
        position: begin.saturating_sub(part.begin),
        wanted,
        brackets: 0,
        symbols,
        open: vec![],
        out,
    };
    // A byte order mark is not part of the scene.
    if begin == 0 && part.bytes.starts_with(b"\xef\xbb\xbf") {
        lexer.position = 3;
    }
    lexer.run();
    lexer.out
}

/// The length in bytes of the first token of `rest`, for underlining it.
pub(crate) fn token_length(rest: &[u8]) -> usize {
    let count = |f: fn(&u8) -> bool| rest.iter().take_while(|b| f(b)).count();
    match rest.first() {
        None => 1,
        Some(b) if is_name_start(*b) => count(|b| is_name(*b)),
        Some(b'#') => {
            let blank = rest[1..].iter().take_while(|b| is_blank(**b)).count();
            let word = rest[1 + blank..].iter().take_while(|b| is_name(**b));
            1 + blank + word.count()
        }
        Some(b'"') => {
            let line = rest[1..]
                .iter()
                .take_while(|b| !matches!(**b, b'"' | b'\n' | b'\r'));
            line.count() + 2
        }
        Some(b) if b.is_ascii_digit() || *b == b'.' => number::number_length(rest).max(1),
        Some(b'<' | b'>' | b'!') if rest.get(1) == Some(&b'=') => 2,
        Some(_) => 1,
    }
}

/// The advice for a block without an end.
pub(crate) const UNCLOSED: &str = "every `#if`, `#ifdef`, `#ifndef`, `#while`, `#for`, `#switch` and `#macro` needs an `#end` in the same file";

struct Lexer<'a> {
    bytes: &'a [u8],
    /// The offset in the file of the first of the bytes.
    base: usize,
    /// Whether the file ends with the bytes.
    is_last: bool,
    /// Index of the next of the bytes.
    position: usize,
    /// The wanted number of tokens in the chunk.
    wanted: usize,
    /// The number of open parentheses and brackets.
    brackets: u32,
    symbols: &'a mut Symbols,
    /// Indices of the last divider of each open block.
    open: Vec<usize>,
    out: Lexed,
}

const fn is_blank(b: u8) -> bool {
    matches!(b, b' ' | b'\t' | b'\r' | b'\n' | 0x0b | 0x0c | 0x1a | 0)
}

const fn is_name_start(b: u8) -> bool {
    b.is_ascii_alphabetic() || b == b'_'
}

/// The kinds of tokens that can begin with a byte.
#[derive(Clone, Copy)]
enum First {
    Blank,
    Digit,
    Name,
    Dot,
    Slash,
    Quote,
    Hash,
    Less,
    Other,
}

/// The table of first bytes, read once per token.
const FIRST: [First; 256] = {
    let mut table = [First::Other; 256];
    let mut index = 0;
    while index < 256 {
        let b = index as u8;
        table[index] = match b {
            b if is_blank(b) => First::Blank,
            b'0'..=b'9' => First::Digit,
            b if is_name_start(b) => First::Name,
            b'.' => First::Dot,
            b'/' => First::Slash,
            b'"' => First::Quote,
            b'#' => First::Hash,
            b'<' => First::Less,
            _ => First::Other,
        };
        index += 1;
    }
    table
};

/// The bytes that can continue a name.
const NAME: [bool; 256] = {
    let mut table = [false; 256];
    let mut b = 0;
    while b < 256 {
        table[b] = (b as u8).is_ascii_alphanumeric() || b as u8 == b'_';
        b += 1;
    }
    table
};

fn is_name(b: u8) -> bool {
    NAME[b as usize]
}

impl<'a> Lexer<'a> {
    fn at(&self, offset: usize) -> u8 {
        self.bytes.get(self.position + offset).copied().unwrap_or(0)
    }

    fn push(&mut self, kind: Kind, start: usize, bits: u64) {
        self.out.tokens.push(Token {
            kind,
            start: (self.base + start) as u32,
            bits,
        });
    }

    fn problem(&mut self, start: usize, message: impl Into<String>, hint: &'static str) {
        // A binary file would give one problem per byte.
        if self.out.problems.len() < 20 {
            self.out.problems.push(LexProblem {
                start: (self.base + start) as u32,
                message: message.into(),
                hint,
            });
        }
    }

    fn run(&mut self) {
        while let Some(&byte) = self.bytes.get(self.position) {
            let start = self.position;
            match FIRST[byte as usize] {
                First::Blank => self.position += 1,
                First::Digit => self.number(),
                First::Name => {
                    let length = self.name().len();
                    let rest = self.bytes.get(start..).unwrap_or(&[]);
                    let symbol = self.symbols.intern_front(rest, length);
                    let known = (symbol.index()) < Word::ALL.len();
                    let kind = if known && !self.is_freed(symbol) {
                        Kind::Word
                    } else {
                        Kind::Name
                    };
                    if self.out.tokens.len() >= self.wanted
                        && kind == Kind::Word
                        && self.ends_before_object(Word::from_number(u64::from(symbol.0)))
                    {
                        return self.end_chunk(start);
                    }
                    self.push(kind, start, u64::from(symbol.0));
                }
                First::Less
                    if self.out.tokens.len() >= self.wanted && self.ends_before_vector() =>
                {
                    return self.end_chunk(start);
                }
                First::Dot if self.at(1).is_ascii_digit() => self.number(),
                First::Slash if self.at(1) == b'/' => self.line_comment(),
                First::Slash if self.at(1) == b'*' => self.block_comment(),
                First::Quote => self.string(),
                First::Hash => self.directive(),
                _ => self.punctuation(byte),
            }
        }
        if !self.is_last {
            self.out.is_cut = true;
            return;
        }
        let end = self.bytes.len();
        self.push(Kind::End, end, 0);
        if let Some(token) = self.open.first().map(|index| self.out.tokens[*index]) {
            let word = token.directive().map_or("", Directive::text);
            let message = format!("`#{word}` has no `#end`");
            self.problem(token.start as usize - self.base, message, UNCLOSED);
        }
    }

    /// Whether the chunk may end before a word: after a complete item, if the word opens an object.
    fn ends_before_object(&self, word: Option<Word>) -> bool {
        let closed = self.out.tokens.last().map(|t| t.kind) == Some(Kind::RightBrace);
        closed && self.is_between() && word.is_some_and(|w| w.kind() == WordKind::Object)
    }

    /// Whether the chunk may end before a `<`: between the vectors of a list.
    fn ends_before_vector(&self) -> bool {
        let kinds = |&[a, b]: &[Token; 2]| a.kind == Kind::Greater && b.kind == Kind::Comma;
        self.is_between() && self.out.tokens.last_chunk().is_some_and(kinds)
    }

    fn is_between(&self) -> bool {
        self.brackets == 0 && self.open.is_empty()
    }

    /// Ends the chunk before the token at `start`.
    fn end_chunk(&mut self, start: usize) {
        self.push(Kind::End, start, 0);
        self.out.rest = Some(self.base + start);
    }

    fn punctuation(&mut self, byte: u8) {
        let start = self.position;
        let equal = self.at(1) == b'=';
        let (kind, length) = match byte {
            b'{' => (Kind::LeftBrace, 1),
            b'}' => (Kind::RightBrace, 1),
            b'(' => (Kind::LeftParen, 1),
            b')' => (Kind::RightParen, 1),
            b'<' if equal => (Kind::LessEqual, 2),
            b'<' => (Kind::Less, 1),
            b'>' if equal => (Kind::GreaterEqual, 2),
            b'>' => (Kind::Greater, 1),
            b'!' if equal => (Kind::NotEqual, 2),
            b'!' => (Kind::Bang, 1),
            b'=' => (Kind::Equal, 1),
            b'[' => (Kind::LeftBracket, 1),
            b']' => (Kind::RightBracket, 1),
            b',' => (Kind::Comma, 1),
            b';' => (Kind::Semicolon, 1),
            b'.' => (Kind::Dot, 1),
            b'+' => (Kind::Plus, 1),
            b'-' => (Kind::Minus, 1),
            b'*' => (Kind::Star, 1),
            b'/' => (Kind::Slash, 1),
            b'^' => (Kind::Caret, 1),
            b'?' => (Kind::Question, 1),
            b':' => (Kind::Colon, 1),
            b'&' => (Kind::Ampersand, 1),
            b'|' => (Kind::Bar, 1),
            _ => (Kind::Unknown, 1),
        };
        match kind {
            Kind::LeftParen | Kind::LeftBracket => self.brackets = self.brackets.saturating_add(1),
            Kind::RightParen | Kind::RightBracket => {
                self.brackets = self.brackets.saturating_sub(1);
            }
            _ => {}
        }
        self.position += length;
        self.push(kind, start, u64::from(byte));
    }

    fn name(&mut self) -> &'a [u8] {
        let bytes = self.bytes;
        let rest = &bytes[self.position..];
        let length = rest.iter().position(|b| !is_name(*b)).unwrap_or(rest.len());
        self.position += length;
        &rest[..length]
    }

    fn number(&mut self) {
        let start = self.position;
        let rest = &self.bytes[start..];
        let (value, length) = number::number(rest);
        self.position += length;
        let (text, rest) = rest.split_at(length);
        let is_whole = text.iter().all(u8::is_ascii_digit);
        if !is_whole && matches!(rest, [b'.', b'0'..=b'9', ..]) {
            let help = "remove one of the points, or put a comma between two numbers";
            self.problem(self.position, "this number has a second point", help);
        }
        self.push(Kind::Number, start, value.to_bits());
    }

    fn string(&mut self) {
        let start = self.position;
        let rest = &self.bytes[start + 1..];
        let mut end = 0;
        let mut escaped = false;
        loop {
            match rest.get(end) {
                None => {
                    self.position = self.bytes.len();
                    self.problem(start, "this string does not end", "end it with `\"`");
                    break;
                }
                Some(b'"') => {
                    self.position = start + end + 2;
                    break;
                }
                Some(b'\\') => {
                    escaped = true;
                    end += 2;
                }
                Some(_) => end += 1,
            }
        }
        let text = decode(rest.get(..end).unwrap_or(rest));
        let text = if escaped { text::unescape(&text) } else { text };
        let index = self.out.strings.len();
        self.out.strings.push(text.into());
        self.push(Kind::String, start, index as u64);
    }

    /// Whether a keyword is a name here because the scene declares it: words that are new in 3.8 were names before.
    fn is_freed(&mut self, symbol: Symbol) -> bool {
        /// The largest number of tokens to look back for the head of a macro.
        const PARAMETERS: usize = 200;
        if self.symbols.is_freed(symbol) {
            return true;
        }
        let Some(word) = Word::from_number(u64::from(symbol.0)).filter(|w| w.is_new()) else {
            return false;
        };
        let tokens = &self.out.tokens;
        let before = |n: usize| tokens.len().checked_sub(n).and_then(|at| tokens.get(at));
        let directive = |n: usize| before(n).and_then(|t| t.directive());
        let rest = self.bytes.get(self.position..).unwrap_or(&[]);
        let next = rest.iter().copied().find(|b| !is_blank(*b)).unwrap_or(0);
        let declared = match (directive(1), directive(2)) {
            (Some(Directive::Declare | Directive::Local), _) => matches!(next, b'=' | b'['),
            (Some(Directive::Macro), _) => next == b'(',
            (_, Some(Directive::For)) => next == b',',
            // A parameter of a macro: only names and commas are between the opening parenthesis and the word.
            _ => {
                let list = tokens.iter().rev().take(PARAMETERS).take_while(|t| {
                    matches!(
                        t.kind,
                        Kind::Name | Kind::Word | Kind::Comma | Kind::LeftParen
                    )
                });
                let head = tokens.len() - list.count();
                let head = head.checked_sub(1).and_then(|at| tokens.get(at));
                head.and_then(|t| t.directive()) == Some(Directive::Macro)
                    && word != Word::Optional
                    && matches!(next, b',' | b')')
            }
        };
        if declared {
            self.symbols.free(symbol);
        }
        declared
    }

    fn directive(&mut self) {
        let start = self.position;
        self.position += 1;
        let mut on_next_line = false;
        while is_blank(self.at(0)) && self.position < self.bytes.len() {
            on_next_line |= matches!(self.at(0), b'\n' | b'\r');
            self.position += 1;
        }
        let begin = self.position;
        let mut name = if is_name_start(self.at(0)) {
            self.name()
        } else {
            &[]
        };
        let directive = Directive::from_text(std::str::from_utf8(name).unwrap_or(""));
        if directive == Directive::Unknown && (on_next_line || self.is_plain_word(name)) {
            // A lone `#` has no meaning; the text after it is read separately.
            name = &[];
            self.position = begin;
        }
        let index = self.out.tokens.len();
        let mut token = Token::new_directive((self.base + start) as u32, directive);
        if directive.opens() {
            self.open.push(index);
        } else if directive.divides() || directive == Directive::End {
            if let Some(last) = self.open.pop() {
                self.out.tokens[last].set_link(index);
            }
            if directive.divides() {
                self.open.push(index);
            }
        } else if directive == Directive::Unknown {
            // Keeps the word for the error message.
            token.set_link(self.symbols.intern(name).index());
        }
        self.out.tokens.push(token);
    }

    /// Whether a name is a keyword that was never a directive.
    fn is_plain_word(&mut self, name: &[u8]) -> bool {
        let word = Word::from_number(u64::from(self.symbols.intern(name).0));
        word.is_some_and(|word| !matches!(word, Word::MaxTraceLevel | Word::MaxIntersections))
    }

    fn line_comment(&mut self) {
        let rest = &self.bytes[self.position..];
        let end = memchr::memchr2(b'\n', b'\r', rest);
        self.position += end.unwrap_or(rest.len());
    }

    /// Comments nest.
    fn block_comment(&mut self) {
        let start = self.position;
        let mut depth = 0usize;
        while self.position < self.bytes.len() {
            match (self.at(0), self.at(1)) {
                (b'/', b'*') => {
                    depth += 1;
                    self.position += 2;
                }
                (b'*', b'/') => {
                    depth -= 1;
                    self.position += 2;
                    if depth == 0 {
                        return;
                    }
                }
                _ => self.position += 1,
            }
        }
        self.position = self.bytes.len();
        self.problem(
            start,
            "this comment does not end",
            "end it with `*/`; comments nest, so every `/*` inside needs a `*/` of its own",
        );
    }
}
