//! Bytes to tokens, a chunk of the file at a time.
//!
//! Besides cutting the text the lexer links the directives of each block (`#if` to `#else` to `#end`), so that skipping a
//! branch or jumping back to the head of a loop costs nothing.
//!
//! A chunk of a long file ends where no block, parenthesis or bracket is open, and only before a word that opens an object or
//! between two vectors of a list: there nobody looks at the next token without [`Parser::peek`](crate::Parser::peek), which goes on
//! with the next chunk. So nothing ever jumps from one chunk into another, and the tokens of an exported scene of any size
//! stay in the processor's cache.

use crate::keywords::{Word, WordKind};
use crate::source::Part;
use crate::symbol::{Symbol, Symbols};
use crate::token::{Directive, Kind, Token};
use std::sync::Arc;

/// Something wrong with the text itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct LexProblem {
    /// Byte offset.
    pub(crate) start: u32,
    /// What is wrong.
    pub(crate) message: String,
    /// What to do.
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
    /// Whether the part of the text has ended before the chunk, so that this is good for nothing.
    pub(crate) is_cut: bool,
}

/// Cuts a part of a text into tokens, from a byte offset (of the file) up to the first good place behind `wanted` tokens. The text
/// must be shorter than 4 GiB (the source loader sees to it).
///
/// The vectors of `used` are used again.
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
    // A byte order mark is no character of the scene.
    if begin == 0 && part.bytes.starts_with(b"\xef\xbb\xbf") {
        lexer.position = 3;
    }
    lexer.run();
    lexer.out
}

/// The length in bytes of the token that `rest` begins with, for underlining it.
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
            let line = rest[1..].iter().take_while(|b| **b != b'"' && **b != b'\n');
            line.count() + 2
        }
        Some(b) if b.is_ascii_digit() || *b == b'.' => Lexer::number_length(rest).max(1),
        Some(b'<' | b'>' | b'!') if rest.get(1) == Some(&b'=') => 2,
        Some(_) => 1,
    }
}

/// What to do about a block without end.
pub(crate) const UNCLOSED: &str = "every `#if`, `#ifdef`, `#ifndef`, `#while`, `#for`, `#switch` and `#macro` needs an `#end` in the same file";

struct Lexer<'a> {
    bytes: &'a [u8],
    /// The offset in the file of the first of the bytes.
    base: usize,
    /// Whether the file ends with the bytes.
    is_last: bool,
    /// Index of the next of the bytes.
    position: usize,
    /// How many tokens the chunk should have.
    wanted: usize,
    /// How many parentheses and brackets are open.
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

/// What a token can be that begins with a byte.
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

/// By the first byte; looked up once per token.
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

/// Which bytes go on with a name.
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

    /// Whether the chunk may end before a word: behind a complete thing, if the word opens an object.
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

    /// How many bytes at the front of `rest` are a number: digits, a point with digits around it, an exponent.
    fn number_length(rest: &[u8]) -> usize {
        let digits = |from: usize| {
            let rest = rest.get(from..).unwrap_or(&[]);
            rest.iter().take_while(|b| b.is_ascii_digit()).count()
        };
        let mut length = digits(0);
        // `1.x` is the component of a number, not a number with an empty fraction.
        if rest.get(length) == Some(&b'.')
            && !rest
                .get(length + 1)
                .is_some_and(|b| is_name_start(*b) && !matches!(b, b'e' | b'E'))
        {
            length += 1 + digits(length + 1);
        }
        if matches!(rest.get(length), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(rest.get(length + 1), Some(b'+' | b'-')));
            let exponent = digits(length + 1 + sign);
            if exponent > 0 {
                length += 1 + sign + exponent;
            }
        }
        length
    }

    fn number(&mut self) {
        let start = self.position;
        let rest = &self.bytes[start..];
        let (value, length) = short_decimal(rest).unwrap_or_else(|| {
            let length = Self::number_length(rest).max(1);
            let text = std::str::from_utf8(&rest[..length]).unwrap_or("");
            // The text has the form of a number, so parsing it cannot fail.
            (text.parse().unwrap_or(0.0), length)
        });
        self.position += length;
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
        let text = if escaped { unescape(&text) } else { text };
        let index = self.out.strings.len();
        self.out.strings.push(text.into());
        self.push(Kind::String, start, index as u64);
    }

    /// Whether a reserved word is a name here, because the scene declares one: words that came with 3.8 were names before.
    fn is_freed(&mut self, symbol: Symbol) -> bool {
        /// How far to look back for the head of a macro.
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
            (_, Some(Directive::For)) => next == b',',
            // A parameter of a macro: the names since the parenthesis have commas between them.
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
        while is_blank(self.at(0)) && self.position < self.bytes.len() {
            self.position += 1;
        }
        let name = if is_name_start(self.at(0)) {
            self.name()
        } else {
            &[]
        };
        let directive = Directive::from_text(std::str::from_utf8(name).unwrap_or(""));
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
            // Keeps the word for the message.
            token.set_link(self.symbols.intern(name).index());
        }
        self.out.tokens.push(token);
    }

    fn line_comment(&mut self) {
        let rest = &self.bytes[self.position..];
        let end = rest.iter().position(|b| *b == b'\n');
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

/// A decimal number of at most 19 digits with a value the processor computes exactly: the mantissa and the power of ten are
/// both floats without rounding, so one division rounds correctly (Clinger, "How to read floating point numbers
/// accurately", PLDI 1990). `None` if the number is longer or has an exponent.
fn short_decimal(rest: &[u8]) -> Option<(f64, usize)> {
    const POWERS: [f64; 23] = [
        1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
        1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
    ];
    let mut mantissa = 0u64;
    let whole = digits(rest, &mut mantissa)?;
    let (mut length, mut fraction) = (whole, 0);
    if rest.get(length) == Some(&b'.') {
        fraction = digits(rest.get(length + 1..)?, &mut mantissa)?;
        length += 1 + fraction;
    }
    // A name behind it is an exponent, or a component of a number.
    let joined = rest.get(length).is_some_and(|b| is_name_start(*b));
    // So many digits have not overflown the mantissa.
    if joined || whole + fraction > 19 || mantissa > 1 << 53 {
        return None;
    }
    let power = POWERS.get(fraction)?;
    Some((mantissa as f64 / power, length))
}

/// Reads decimal digits on to a mantissa, modulo 2^64, and gives how many there are; `None` if they are too many.
#[inline]
fn digits(rest: &[u8], mantissa: &mut u64) -> Option<usize> {
    const POWERS: [u64; 9] = [
        1,
        10,
        100,
        1000,
        10_000,
        100_000,
        1_000_000,
        10_000_000,
        100_000_000,
    ];
    let mut count = 0;
    while let Some((window, _)) = rest.get(count..)?.split_first_chunk() {
        let (value, more) = leading_digits(u64::from_le_bytes(*window));
        *mantissa = mantissa
            .wrapping_mul(*POWERS.get(more)?)
            .wrapping_add(value);
        count += more;
        if more < 8 {
            return Some(count);
        }
        if count > 16 {
            return None;
        }
    }
    // Near the end of the text.
    for byte in rest.get(count..)?.iter().take_while(|b| b.is_ascii_digit()) {
        *mantissa = mantissa
            .wrapping_mul(10)
            .wrapping_add(u64::from(byte - b'0'));
        count += 1;
    }
    Some(count)
}

/// The value of the digits at the front of eight bytes, and how many they are, all bytes at once.
#[inline]
fn leading_digits(window: u64) -> (u64, usize) {
    const ZEROS: u64 = 0x3030_3030_3030_3030;
    // The upper bit of each byte that is no digit is set: those above `9` by the sum, those below `0` by the difference. What
    // is carried or borrowed changes only bytes behind the first of them.
    let above = window.wrapping_add(0x4646_4646_4646_4646);
    let below = window.wrapping_sub(ZEROS);
    let count = (((above | below) & 0x8080_8080_8080_8080).trailing_zeros() / 8) as usize;
    if count == 0 {
        return (0, 0);
    }
    // Zeros take the place of the digits that are missing in front.
    let d = below << (64 - 8 * count);
    // Pairs of digits, then all: Lemire, "Quickly parsing eight digits", 2018.
    let pairs = d.wrapping_mul(10).wrapping_add(d >> 8);
    const MASK: u64 = 0x0000_00ff_0000_00ff;
    let first = (pairs & MASK).wrapping_mul(100 + (1_000_000 << 32));
    let second = (pairs >> 16 & MASK).wrapping_mul(1 + (10_000 << 32));
    (first.wrapping_add(second) >> 32, count)
}

/// UTF-8 if it is, else Latin-1.
pub(crate) fn decode(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
    }
}

/// Replaces the escape sequences of the language; an unknown one stands for its letter.
fn unescape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut chars = text.chars();
    while let Some(c) = chars.next() {
        if c != '\\' {
            out.push(c);
            continue;
        }
        match chars.next() {
            Some('n') => out.push('\n'),
            Some('t') => out.push('\t'),
            Some('r') => out.push('\r'),
            Some('a') => out.push('\u{7}'),
            Some('b') => out.push('\u{8}'),
            Some('f') => out.push('\u{c}'),
            Some('v') => out.push('\u{b}'),
            Some('0') => out.push('\0'),
            Some('u') => {
                let code = chars.as_str().get(..4);
                let decoded = code
                    .and_then(|c| u32::from_str_radix(c, 16).ok())
                    .and_then(char::from_u32);
                match decoded {
                    Some(c) => {
                        out.push(c);
                        chars = chars.as_str()[4..].chars();
                    }
                    None => out.push('u'),
                }
            }
            Some(other) => out.push(other),
            None => {}
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn whole(bytes: &[u8]) -> Lexed {
        let part = Part {
            bytes,
            begin: 0,
            is_last: true,
        };
        lex(&part, 0, usize::MAX, &mut Symbols::new(), Lexed::default())
    }

    fn kinds(text: &str) -> Vec<Kind> {
        let lexed = whole(text.as_bytes());
        assert_eq!(lexed.problems, []);
        lexed.tokens.iter().map(|t| t.kind).collect()
    }

    fn numbers(text: &str) -> Vec<f64> {
        let lexed = whole(text.as_bytes());
        let numbers = lexed.tokens.iter().filter(|t| t.kind == Kind::Number);
        numbers.map(|t| t.number()).collect()
    }

    #[test]
    fn a_sphere_is_cut_into_its_tokens() {
        use Kind::{Comma, End, Greater, LeftBrace, Less, Minus, Name, Number, RightBrace, Word};
        let text = "sphere{<0,-1,My_2> .5}";
        let expected = [
            Word, LeftBrace, Less, Number, Comma, Minus, Number, Comma, Name, Greater, Number,
            RightBrace, End,
        ];
        assert_eq!(kinds(text), expected);
    }

    #[test]
    fn numbers_are_read_to_the_last_bit() {
        let text = "0 1. .5 1e3 1.5E-3 2e+2 0.1 3.14159265358979323846 123456789012345678901234567890 1e400 4.35 007";
        let expected = [
            0.0,
            1.0,
            0.5,
            1e3,
            1.5e-3,
            2e2,
            0.1,
            std::f64::consts::PI,
            123456789012345678901234567890.0,
            f64::INFINITY,
            4.35,
            7.0,
        ];
        assert_eq!(numbers(text), expected);
        // Every way through the reader agrees with the standard library.
        let mut state = 1u64;
        for _ in 0..20_000 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            let digits = (state >> 60) as usize;
            let text = format!("{:.*}", digits, (state >> 11) as f64 / 1e12);
            assert_eq!(numbers(&text), [text.parse::<f64>().unwrap()], "{text}");
        }
    }

    #[test]
    fn points_that_are_no_fractions() {
        assert_eq!(kinds("A.x"), [Kind::Name, Kind::Dot, Kind::Word, Kind::End]);
        assert_eq!(
            kinds("2.x"),
            [Kind::Number, Kind::Dot, Kind::Word, Kind::End]
        );
        assert_eq!(numbers("1.5.5"), [1.5, 0.5]);
    }

    #[test]
    fn comments_nest_and_strings_hide_them() {
        assert_eq!(
            kinds("1 /* a /* b */ // c */ 2 // d \n+"),
            [Kind::Number, Kind::Number, Kind::Plus, Kind::End]
        );
        let lexed = whole(br#""/* \"quoted\" \u00e9\n""#);
        assert_eq!(lexed.strings, [Arc::from("/* \"quoted\" \u{e9}\n")]);
        let latin = whole(b"\"caf\xe9\"");
        assert_eq!(latin.strings, [Arc::from("caf\u{e9}")]);
    }

    #[test]
    fn unfinished_text_is_reported_where_it_starts() {
        for (text, start) in [("1 /* /* */", 2), ("12 \"abc", 3), ("\"a\\", 0)] {
            let lexed = whole(text.as_bytes());
            assert_eq!(lexed.problems.len(), 1, "{text}");
            assert_eq!(lexed.problems[0].start, start);
            assert_eq!(lexed.tokens.last().map(|t| t.kind), Some(Kind::End));
        }
    }

    #[test]
    fn blocks_are_linked() {
        let text =
            "#if(1) #while(0) #end #else # switch(1) #case(1) #break #end #end #end #macro A()";
        let lexed = whole(text.as_bytes());
        let directives: Vec<&Token> = lexed
            .tokens
            .iter()
            .filter(|t| t.kind == Kind::Directive)
            .collect();
        let place = |i: usize| {
            let link = directives[i].link()?;
            directives.iter().position(|d| **d == lexed.tokens[link])
        };
        // if 0, while 1, end 2, else 3, switch 4, case 5, break 6, end 7, end 8, end 9 (one too many), macro 10.
        assert_eq!(place(0), Some(3));
        assert_eq!(place(1), Some(2));
        assert_eq!(place(3), Some(8));
        assert_eq!(place(4), Some(5));
        assert_eq!(place(5), Some(7));
        assert_eq!((place(9), place(10)), (None, None));
    }

    #[test]
    fn lengths_for_carets() {
        let text = b"sphere <= 1.5e3 # include \"ab\"";
        let length = |start: usize| token_length(text.get(start..).unwrap_or(&[]));
        assert_eq!(length(0), 6);
        assert_eq!(length(7), 2);
        assert_eq!(length(10), 5);
        assert_eq!(length(16), 9);
        assert_eq!(length(26), 4);
        assert_eq!(length(999), 1);
    }
}
