//! Words and numbers of text formats, each with its place.

use super::Report;
use strahl_math::decimal;
use strahl_scene::{Diagnostic, FileId, Span};

/// A text with the name it has in messages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Text<'a> {
    pub(crate) bytes: &'a [u8],
    pub(crate) name: &'a str,
    pub(crate) file: FileId,
}

/// A word of a text: no blanks, not empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Word<'a> {
    pub(crate) bytes: &'a [u8],
    /// Where it starts, in bytes from the start of the text.
    pub(crate) start: usize,
    /// Its line, counted from 1.
    pub(crate) line: u32,
}

impl Word<'_> {
    /// The word for messages: lossy and shortened.
    pub(crate) fn shown(&self) -> String {
        const MOST: usize = 40;
        let mut text: String =
            String::from_utf8_lossy(&self.bytes[..self.bytes.len().min(4 * MOST)])
                .chars()
                .map(|c| if c.is_control() { '\u{fffd}' } else { c })
                .collect();
        if let Some((end, _)) = text.char_indices().nth(MOST) {
            text.truncate(end);
            text.push_str("...");
        }
        text
    }
}

/// The text without the byte order mark that many programs on Windows begin texts in UTF-8 with.
pub(crate) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

impl<'a> Text<'a> {
    /// A text; a byte order mark at its begin is no part of it.
    pub(crate) fn new(bytes: &'a [u8], name: &'a str, file: FileId) -> Self {
        let bytes = without_mark(bytes);
        Self { bytes, name, file }
    }

    /// The words of the text from byte `start` in line `line`.
    pub(crate) fn words(self, start: usize, line: u32) -> Words<'a> {
        Words {
            text: self,
            at: start,
            line,
            comment: Some(b'#'),
            continued: false,
            last: None,
        }
    }

    /// Says an error about `length` bytes from `start` in line `line`, with the line and a caret.
    pub(crate) fn place(
        self,
        diagnostic: Diagnostic,
        start: usize,
        length: usize,
        line: u32,
    ) -> Diagnostic {
        let is_end = |b: &u8| matches!(b, b'\n' | b'\r');
        let start = start.min(self.bytes.len());
        let first = self.bytes[..start]
            .iter()
            .rposition(is_end)
            .map_or(0, |p| p + 1);
        // What is shown of a very long line is not far from the place.
        let until = start + length.min(1000) + 1000;
        let rest = &self.bytes[start..until.min(self.bytes.len())];
        let last = start + rest.iter().position(is_end).unwrap_or(rest.len());
        let characters = |bytes: &[u8]| String::from_utf8_lossy(bytes).chars().count() as u32;
        let column = characters(&self.bytes[first..start]) + 1;
        let covered = characters(&self.bytes[start..last.min(start + length)]).max(1);
        let span = Span {
            file: self.file,
            line,
            column,
            length: covered,
        };
        diagnostic.at(span).with_source(
            self.name,
            &String::from_utf8_lossy(&self.bytes[first..last]),
        )
    }

    /// Says an error about a word.
    pub(crate) fn at(self, word: &Word<'_>, diagnostic: Diagnostic) -> Diagnostic {
        self.place(diagnostic, word.start, word.bytes.len(), word.line)
    }

    /// Whether the text is none: its beginning has bytes that no text has.
    pub(crate) fn is_binary(self) -> bool {
        let start = &self.bytes[..self.bytes.len().min(1024)];
        start.iter().any(|b| {
            b.is_ascii_control() && !matches!(b, b'\t' | b'\n' | b'\r' | 0x0c | 0x1a | 0x1b)
        })
    }

    /// Reports a binary file, and says whether it is one.
    pub(crate) fn refuse_binary(self, what: &str, report: &mut Report) -> bool {
        let binary = self.is_binary();
        if binary {
            report.error(|| {
                Diagnostic::error(format!(
                    "`{}` is not {what}: it is a binary file, not a text",
                    self.name
                ))
                .hint("name the format with `--scene-format` if the file extension is wrong")
            });
        }
        binary
    }
}

/// Goes through the words of a text. Blanks and line ends separate words; a word that begins with `#` starts a comment
/// until the end of the line.
#[derive(Clone, Debug)]
pub(crate) struct Words<'a> {
    text: Text<'a>,
    at: usize,
    line: u32,
    comment: Option<u8>,
    /// Whether a backslash at the end of a line joins it with the next.
    continued: bool,
    last: Option<Word<'a>>,
}

impl<'a> Words<'a> {
    /// Without comments: every word counts.
    pub(crate) fn without_comments(self) -> Self {
        Self {
            comment: None,
            ..self
        }
    }

    /// With backslashes at the ends of lines that go on in the next one.
    pub(crate) fn with_continuation(self) -> Self {
        Self {
            continued: true,
            ..self
        }
    }

    /// The next word, if there is one.
    pub(crate) fn next(&mut self) -> Option<Word<'a>> {
        self.skip_blanks(true);
        self.word()
    }

    /// The next word if it is in the line of the last one.
    pub(crate) fn next_in_line(&mut self) -> Option<Word<'a>> {
        self.skip_blanks(false);
        self.word()
    }

    /// The next word of the line that ends where a comment begins, even without a blank before it: for numbers, in which no
    /// name can have such a sign.
    pub(crate) fn next_uncommented(&mut self) -> Option<Word<'a>> {
        let word = self.next_in_line()?;
        Some(self.uncommented(word))
    }

    /// The part of the word just taken that is not in a comment; the comment is next then.
    pub(crate) fn uncommented(&mut self, mut word: Word<'a>) -> Word<'a> {
        let comment = self
            .comment
            .and_then(|comment| word.bytes.iter().position(|b| *b == comment));
        // That of `1.#QNAN` is none.
        let is_nan = |at: usize| {
            word.bytes[..at].ends_with(b"1.")
                && word.bytes.get(at + 1).is_some_and(u8::is_ascii_uppercase)
        };
        if let Some(length) = comment.filter(|at| !is_nan(*at)) {
            word.bytes = &word.bytes[..length];
            self.at = word.start + length;
            self.last = Some(word);
        }
        word
    }

    /// The next word as a number, if it is one of not too many digits; if it is anything else, nothing is taken. What
    /// [`parse_f64`] would say of the word, without looking for its end first.
    #[inline]
    pub(crate) fn short_number(&mut self) -> Option<f64> {
        self.take_if(true, short_number)
    }

    /// The same if the word is in the line of the last one.
    #[inline]
    pub(crate) fn short_number_in_line(&mut self) -> Option<f64> {
        self.take_if(false, short_number)
    }

    /// The next word of the line as a whole number, if it is one of at most nine digits; if it is anything else, nothing
    /// is taken.
    #[inline]
    pub(crate) fn short_integer_in_line(&mut self) -> Option<i32> {
        self.take_if(false, |rest| {
            let mut number = 0;
            let length = decimal::digits(rest, &mut number).filter(|n| (1..=9).contains(n))?;
            Some((i32::try_from(number).ok()?, length))
        })
    }

    /// Takes the next word if `read` makes something of its bytes, and tells how many it has.
    #[inline]
    fn take_if<T>(&mut self, lines: bool, read: impl Fn(&[u8]) -> Option<(T, usize)>) -> Option<T> {
        let before = (self.at, self.line);
        self.skip_blanks(lines);
        let rest = self.text.bytes.get(self.at..)?;
        let ends = |length| {
            rest.get(length)
                .is_none_or(|b: &u8| is_blank(*b) || is_end(*b))
        };
        let Some((value, length)) = read(rest).filter(|(_, length)| ends(*length)) else {
            (self.at, self.line) = before;
            return None;
        };
        self.last = Some(Word {
            bytes: &rest[..length],
            start: self.at,
            line: self.line,
        });
        self.at += length;
        Some(value)
    }

    /// The next word of the line without taking it.
    pub(crate) fn peek_in_line(&self) -> Option<Word<'a>> {
        self.clone().next_in_line()
    }

    /// The next word without taking it.
    pub(crate) fn peek(&self) -> Option<Word<'a>> {
        self.clone().next()
    }

    /// Goes to the end of the line, with continuations; returns what is left of it.
    pub(crate) fn skip_line(&mut self) -> &'a [u8] {
        let start = self.at;
        loop {
            let part = self.skip_to_end();
            let joined =
                self.continued && part.last() == Some(&b'\\') && self.at < self.text.bytes.len();
            if !joined {
                return &self.text.bytes[start..self.at];
            }
            self.skip_end();
        }
    }

    /// Goes to the next line end; returns what is passed.
    fn skip_to_end(&mut self) -> &'a [u8] {
        let rest = &self.text.bytes[self.at..];
        let length = rest.iter().position(|b| is_end(*b)).unwrap_or(rest.len());
        self.at += length;
        &rest[..length]
    }

    /// Passes the line end that is next: LF, CR LF or CR.
    fn skip_end(&mut self) {
        self.at += if self.text.bytes[self.at..].starts_with(b"\r\n") {
            2
        } else {
            1
        };
        self.line = self.line.saturating_add(1);
    }

    /// Whether a backslash that joins lines is next.
    fn at_continuation(&self, at: usize) -> bool {
        self.continued
            && self.text.bytes[at] == b'\\'
            && self.text.bytes.get(at + 1).is_some_and(|b| is_end(*b))
    }

    /// Goes to the next word without taking it; says whether there is one.
    pub(crate) fn advance(&mut self) -> bool {
        self.skip_blanks(true);
        self.at < self.text.bytes.len()
    }

    /// Where the next byte is.
    pub(crate) fn position(&self) -> usize {
        self.at
    }

    /// The line of the next byte, counted from 1.
    pub(crate) fn line(&self) -> u32 {
        self.line
    }

    /// The same kind of words of the same text from another byte, which is in line `line`.
    pub(crate) fn from(&self, start: usize, line: u32) -> Self {
        Self {
            at: start,
            line,
            last: None,
            ..self.clone()
        }
    }

    /// All of the text.
    pub(crate) fn text(&self) -> &'a [u8] {
        self.text.bytes
    }

    /// The word that was taken last.
    pub(crate) fn last(&self) -> Option<Word<'a>> {
        self.last
    }

    fn word(&mut self) -> Option<Word<'a>> {
        let rest = &self.text.bytes[self.at..];
        let mut length = rest
            .iter()
            .position(|b| is_blank(*b) || is_end(*b))
            .unwrap_or(rest.len());
        if length > 1 && self.at_continuation(self.at + length - 1) {
            length -= 1;
        }
        if length == 0 {
            return None;
        }
        let word = Word {
            bytes: &rest[..length],
            start: self.at,
            line: self.line,
        };
        self.at += length;
        self.last = Some(word);
        Some(word)
    }

    fn skip_blanks(&mut self, lines: bool) {
        while let Some(&byte) = self.text.bytes.get(self.at) {
            if is_end(byte) {
                if !lines {
                    return;
                }
                self.skip_end();
            } else if is_blank(byte) {
                self.at += 1;
            } else if Some(byte) == self.comment {
                self.skip_to_end();
            } else if self.at_continuation(self.at) {
                self.at += 1;
                self.skip_end();
            } else {
                return;
            }
        }
    }

    /// An error about what should come next and does not: at the next word, or behind the last one at the end of the text.
    pub(crate) fn expected(&self, what: &str) -> Diagnostic {
        let problem = |found: &str| Diagnostic::error(format!("expected {what}, found {found}"));
        match (self.peek(), self.last) {
            (Some(word), _) => self.text.at(&word, problem(&format!("`{}`", word.shown()))),
            (None, Some(last)) => self.text.place(
                problem("the end of the file"),
                last.start + last.bytes.len(),
                1,
                last.line,
            ),
            (None, None) => self
                .text
                .place(problem("the end of the file"), 0, 1, self.line),
        }
    }

    /// An error about what should come next in the line and does not.
    pub(crate) fn expected_in_line(&self, what: &str) -> Diagnostic {
        if self.peek_in_line().is_some() {
            return self.expected(what);
        }
        let problem = Diagnostic::error(format!("expected {what}, found the end of the line"));
        match self.last {
            Some(last) => self
                .text
                .place(problem, last.start + last.bytes.len(), 1, last.line),
            None => self.text.place(problem, self.at, 1, self.line),
        }
    }
}

fn is_end(byte: u8) -> bool {
    matches!(byte, b'\n' | b'\r')
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | 0x0b | 0x0c)
}

/// Why a word is not the number that is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NumberError {
    /// It is not a number.
    NotANumber,
    /// It is NaN, infinite, or too large for the type.
    NotFinite,
}

impl NumberError {
    /// As a diagnostic about `word`, which should be `what`.
    pub(crate) fn describe(self, word: &Word<'_>, what: &str) -> Diagnostic {
        let shown = word.shown();
        match self {
            Self::NotANumber => Diagnostic::error(format!("expected {what}, found `{shown}`"))
                .hint("numbers are written like `-1`, `0.5` or `2.5e-3`"),
            Self::NotFinite => Diagnostic::error(format!(
                "expected {what}, found `{shown}`, which is not a finite number"
            )),
        }
    }
}

/// The number at the front of a text and how many bytes it takes, if it has not too many digits.
#[inline]
fn short_number(text: &[u8]) -> Option<(f64, usize)> {
    match text {
        [b'-', digits @ ..] => decimal::short(digits).map(|(value, n)| (-value, n + 1)),
        _ => decimal::short(text),
    }
}

/// What a word is that Rust does not read as a number: C libraries print NaN and infinity like `-nan(ind)` and `1.#QNAN`, too.
#[cold]
fn no_number(word: &[u8]) -> NumberError {
    let word = word.to_ascii_lowercase();
    let digits = word.strip_prefix(b"-").unwrap_or(&word);
    if digits.starts_with(b"nan(") || digits.starts_with(b"1.#") {
        NumberError::NotFinite
    } else {
        NumberError::NotANumber
    }
}

/// A finite f64, the nearest to what is written.
pub(crate) fn parse_f64(word: &[u8]) -> Result<f64, NumberError> {
    // Nearly all numbers are short ones.
    if let Some((value, length)) = short_number(word)
        && length == word.len()
    {
        return Ok(value);
    }
    let text = std::str::from_utf8(word).map_err(|_| NumberError::NotANumber)?;
    let value: f64 = text.parse().map_err(|_| no_number(word))?;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(NumberError::NotFinite)
    }
}

/// A finite f32, the nearest to what is written.
pub(crate) fn parse_f32(word: &[u8]) -> Result<f32, NumberError> {
    let text = std::str::from_utf8(word).map_err(|_| NumberError::NotANumber)?;
    let value: f32 = text.parse().map_err(|_| no_number(word))?;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(NumberError::NotFinite)
    }
}

/// A whole number.
pub(crate) fn parse_integer(word: &[u8]) -> Result<i64, NumberError> {
    std::str::from_utf8(word)
        .ok()
        .and_then(|text| text.parse().ok())
        .ok_or(NumberError::NotANumber)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(bytes: &[u8]) -> Text<'_> {
        Text::new(bytes, "a.txt", FileId(0))
    }

    #[test]
    fn words_know_their_lines_for_all_line_ends() {
        let mut words = text(b"a b # c\r\n\r d\n\n e#f").words(0, 1);
        let mut all = vec![];
        while let Some(word) = words.next() {
            all.push((word.shown(), word.line));
        }
        let expected = [("a", 1), ("b", 1), ("d", 3), ("e#f", 5)];
        assert_eq!(all, expected.map(|(w, l)| (w.to_owned(), l)));
    }

    #[test]
    fn a_comment_may_touch_a_number() {
        let mut words = text(b"1 2#3 4\n5 #").words(0, 1);
        words.next();
        let two = words.next_uncommented().map(|w| w.shown());
        assert_eq!(
            (two.as_deref(), words.next_uncommented()),
            (Some("2"), None)
        );
        assert_eq!(words.next().map(|w| w.shown()).as_deref(), Some("5"));
        assert_eq!(words.next_uncommented(), None);
        let nan = text(b"-1.#IND").words(0, 1).next_uncommented();
        assert_eq!(nan.map(|w| w.bytes), Some(b"-1.#IND".as_slice()));
        let mut plain = text(b"1#2").words(0, 1).without_comments();
        assert_eq!(
            plain.next_uncommented().map(|w| w.bytes),
            Some(b"1#2".as_slice())
        );
    }

    #[test]
    fn a_backslash_joins_lines_if_asked_for() {
        let t = text(b"f 1 2\\\n3 \\\r\n 4\nx \\\ny\nz # c\\\nw");
        let mut words = t.words(0, 1).with_continuation();
        let mut line = vec![];
        words.next();
        while let Some(word) = words.next_in_line() {
            line.push((word.shown(), word.line));
        }
        assert_eq!(
            line,
            [("1", 1), ("2", 1), ("3", 2), ("4", 3)].map(|(w, l)| (w.to_owned(), l))
        );
        assert_eq!(words.next().map(|w| w.line), Some(4));
        assert_eq!(words.skip_line(), b" \\\ny");
        assert_eq!(
            words.next().map(|w| (w.shown(), w.line)),
            Some(("z".into(), 6))
        );
        assert_eq!(
            words.next().map(|w| (w.shown(), w.line)),
            Some(("w".into(), 7))
        );
    }

    #[test]
    fn the_caret_counts_characters_not_bytes() {
        let t = text("äöü x y".as_bytes());
        let mut words = t.words(0, 1);
        words.next();
        let word = words.next().expect("x");
        let shown = t.at(&word, Diagnostic::error("here")).to_string();
        assert_eq!(
            shown,
            "error: here\n --> a.txt:1:5\n  |\n1 | äöü x y\n  |     ^"
        );
    }

    #[test]
    fn the_end_of_the_file_is_a_place_too() {
        let t = text(b"p 3\n1 2\n");
        let mut words = t.words(0, 1);
        while words.next().is_some() {}
        let shown = words.expected("a number").to_string();
        assert_eq!(
            shown,
            "error: expected a number, found the end of the file\n --> a.txt:2:4\n  |\n2 | 1 2\n  |    ^"
        );
    }

    #[test]
    fn numbers_are_finite() {
        assert_eq!(parse_f64(b"-2.5e-3"), Ok(-2.5e-3));
        assert_eq!(parse_f32(b"0.1"), Ok(0.1));
        for word in [
            "nan",
            "inf",
            "-Infinity",
            "1e999",
            "-nan(ind)",
            "NaN(0x1)",
            "-1.#IND00",
            "1.#INF",
        ] {
            assert_eq!(
                parse_f64(word.as_bytes()),
                Err(NumberError::NotFinite),
                "{word}"
            );
        }
        assert_eq!(parse_f32(b"1e39"), Err(NumberError::NotFinite));
        assert_eq!(parse_f64(b"1,5"), Err(NumberError::NotANumber));
        assert_eq!(parse_f64(&[0xff]), Err(NumberError::NotANumber));
        assert_eq!(
            parse_integer(b"99999999999999999999"),
            Err(NumberError::NotANumber)
        );
    }
}
