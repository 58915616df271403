use super::{Source, Text};
use crate::lexer::{self, LexProblem, Lexed};
use crate::symbol::Symbols;
use crate::token::Token;
use std::sync::{Mutex, MutexGuard, PoisonError};
use strahl_scene::{Diagnostic, FileId, SourceLine, Span};

/// The longest line, in bytes, that messages show whole and whose columns count characters: exporters write whole scenes into one
/// line.
const LONG: usize = 4096;

/// A file that is being parsed.
#[derive(Debug)]
pub(crate) struct SourceFile {
    pub(crate) id: FileId,
    pub(crate) name: String,
    reader: Mutex<Reader>,
}

/// The text of a file with its lines.
#[derive(Debug)]
struct Reader {
    text: Text,
    /// The beginnings of the lines; computed when first needed.
    lines: Option<Vec<u32>>,
    /// The last place looked up.
    last: Line,
    /// The last place and its span: a macro in a loop asks for the same one repeatedly.
    last_span: Option<(u32, Span)>,
}

/// The line of a place.
#[derive(Clone, Copy, Debug, Default)]
struct Line {
    /// The place.
    at: u32,
    /// The number of lines that end before it.
    ends: u32,
    /// The beginning of its line.
    begin: u32,
}

impl SourceFile {
    /// `source` must be shorter than 4 GiB.
    pub(crate) fn new(id: FileId, source: Source) -> Self {
        Self {
            id,
            name: source.name,
            reader: Mutex::new(Reader {
                text: source.text,
                lines: None,
                last: Line::default(),
                last_span: None,
            }),
        }
    }

    fn reader(&self) -> MutexGuard<'_, Reader> {
        self.reader.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Length in bytes.
    pub(crate) fn length(&self) -> usize {
        self.reader().text.len()
    }

    /// Whether this certainly has the text of `source`.
    pub(crate) fn is(&self, source: &Source) -> bool {
        self.name == source.name && self.reader().text.is(&source.text)
    }

    /// Splits the text into tokens: see [`lexer::lex`].
    pub(crate) fn lex(
        &self,
        begin: usize,
        wanted: usize,
        symbols: &mut Symbols,
        mut used: Lexed,
    ) -> Lexed {
        /// More bytes than most chunks need.
        const AHEAD: usize = 64 << 10;
        let text = &mut self.reader().text;
        let mut reach = AHEAD;
        loop {
            let part = text.part(begin..begin.saturating_add(reach));
            used = lexer::lex(&part, begin, wanted, symbols, used);
            if !used.is_cut {
                break;
            }
            // The chunk is longer than the part; larger parts limit the repeated work.
            reach = reach.saturating_mul(4);
        }
        if used.rest.is_none()
            && let Some(why) = text.failed()
        {
            used.problems.push(LexProblem {
                start: text.len() as u32,
                message: format!("the file can't be read further: {why}"),
                hint: "render a copy if another program is writing to it",
            });
        }
        used
    }

    /// The place of the token at a byte offset.
    pub(crate) fn span(&self, start: u32) -> Span {
        let reader = &mut *self.reader();
        if let Some((place, span)) = reader.last_span
            && place == start
        {
            return span;
        }
        let span = self.make_span(reader, start);
        reader.last_span = Some((start, span));
        span
    }

    fn make_span(&self, reader: &mut Reader, start: u32) -> Span {
        // The place may be just after the last byte.
        let start = start.min(reader.text.len() as u32);
        let line = reader.line_of(start);
        let (begin, start) = (line.begin as usize, start as usize);
        let is_long = start - begin > LONG;
        let part = reader
            .text
            .part(if is_long { start } else { begin }..start + LONG);
        let column = if is_long {
            start - begin
        } else {
            // Continuation bytes of UTF-8 are not characters.
            let before = part.get(begin..start).iter();
            before.filter(|b| **b & 0xc0 != 0x80).count()
        };
        Span {
            file: self.id,
            line: line.ends + 1,
            column: column as u32 + 1,
            length: lexer::token_length(part.get(start..start + LONG)) as u32,
        }
    }

    /// The text of the line of a span in this file; of a very long line, as in exported files, the surroundings of the place.
    pub(crate) fn excerpt(&self, start: u32, span: Span) -> SourceLine {
        const AROUND: usize = 80;
        let reader = &mut *self.reader();
        let place = (start as usize).min(reader.text.len());
        let begin = reader.line_of(place as u32).begin as usize;
        if place - begin <= LONG {
            let bytes = reader.text.part(begin..begin + LONG + 1);
            let bytes = bytes.get(begin..begin + LONG + 1);
            let end = memchr::memchr2(b'\n', b'\r', bytes);
            if end.is_some() || bytes.len() <= LONG {
                let line = bytes.get(..end.unwrap_or(bytes.len())).unwrap_or(bytes);
                let shown = Diagnostic::error("").at(span);
                let shown = shown.with_source(&self.name, &lexer::decode(line));
                return shown.source.unwrap_or_else(|| SourceLine {
                    file: self.name.clone(),
                    text: String::new(),
                    column: 1,
                    length: 1,
                });
            }
        }
        let (from, to) = (place.saturating_sub(AROUND).max(begin), place + AROUND);
        let part = reader.text.part(from..to);
        let before = lexer::decode(part.get(from..place));
        let behind = part.get(place..to);
        let end = memchr::memchr2(b'\n', b'\r', behind).unwrap_or(behind.len());
        let behind = lexer::decode(behind.get(..end).unwrap_or(behind));
        let length = (behind.chars().count() as u32).clamp(1, span.length.max(1));
        SourceLine {
            file: self.name.clone(),
            column: before.chars().count() as u32 + 1,
            text: before + &behind,
            length,
        }
    }

    /// The text between the quotation marks of a string with escapes left in place, for file names of Windows.
    pub(crate) fn raw_string(&self, token: Token) -> String {
        let begin = token.start as usize + 1;
        let reader = &mut *self.reader();
        let rest = reader
            .text
            .part(begin..begin + LONG)
            .get(begin..begin + LONG);
        let end = rest.iter().position(|b| *b == b'"').unwrap_or(rest.len());
        lexer::decode(&rest[..end])
    }
}

impl Reader {
    /// The beginnings of the lines.
    fn lines(&mut self) -> &[u32] {
        self.lines.get_or_insert_with(|| {
            const PART: usize = 1 << 20;
            let (mut starts, mut at) = (vec![0], 0);
            while at < self.text.len() {
                let part = self.text.part(at..at + PART + 1);
                let bytes = part.get(at..at + PART + 1);
                let (here, next) = ends_among(bytes, PART);
                starts.extend(here.map(|end| (at + end) as u32 + 1));
                at += next;
            }
            starts
        })
    }

    /// The line that contains a byte offset.
    ///
    /// Most places are looked up in ascending order, and continuing from the previous one needs no table of all lines, which
    /// would take a pass over the file and a search with many cache misses.
    fn line_of(&mut self, start: u32) -> Line {
        const NEAR: u32 = 4096;
        const FAR: u32 = 1 << 20;
        let far = if self.lines.is_none() { FAR } else { NEAR };
        let mut last = self.last;
        match start.checked_sub(last.at) {
            Some(passed) if passed <= far => {
                let range = last.at as usize..start as usize + 1;
                let bytes = self.text.part(range.clone()).get(range);
                let (ends, _) = ends_among(bytes, (start - last.at) as usize);
                for end in ends {
                    last.ends += 1;
                    last.begin = last.at + end as u32 + 1;
                }
            }
            // Earlier in the same line.
            None if start >= last.begin => {}
            _ => {
                let lines = self.lines();
                last.ends = lines.partition_point(|s| *s <= start).saturating_sub(1) as u32;
                last.begin = lines.get(last.ends as usize).copied().unwrap_or(0);
            }
        }
        last.at = start;
        self.last = last;
        last
    }
}

/// The ends of lines among the first `count` bytes (`bytes` may have one more), and the number of bytes searched: after each line
/// feed, and after each carriage return without a line feed, as in old files of the Macintosh.
fn ends_among(bytes: &[u8], count: usize) -> (impl Iterator<Item = usize> + '_, usize) {
    let count = count.min(bytes.len());
    let here = bytes.get(..count).unwrap_or(bytes);
    let ends = memchr::memchr2_iter(b'\n', b'\r', here);
    let ends =
        ends.filter(|at| bytes.get(*at) == Some(&b'\n') || bytes.get(*at + 1) != Some(&b'\n'));
    (ends, count)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The text held in memory, and the same text read in parts.
    fn both(text: &str) -> [SourceFile; 2] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.pov");
        std::fs::write(&path, text).unwrap();
        let in_parts = Source {
            name: "a.pov".to_owned(),
            text: Text::in_parts(&path, 512).unwrap(),
        };
        [Source::new("a.pov", text), in_parts].map(|source| SourceFile::new(FileId(3), source))
    }

    #[test]
    fn places_are_lines_and_characters() {
        let text = "sphere\n  \u{e9}\u{e9} box{\r\n";
        for file in both(text) {
            let start = text.find("box").unwrap() as u32;
            let span = file.span(start);
            assert_eq!((span.line, span.column, span.length), (2, 6, 3));
            let shown = file.excerpt(start, span);
            assert_eq!(shown.text, "  \u{e9}\u{e9} box{");
            assert_eq!((shown.column, shown.length), (6, 3));
            // After the last byte there is an empty line.
            let end = file.span(999);
            assert_eq!((end.line, end.column, end.length), (3, 1, 1));
            assert_eq!(file.excerpt(999, end).text, "");
        }
    }

    #[test]
    fn lines_end_by_line_feeds_carriage_returns_or_both() {
        for end in ["\n", "\r", "\r\n"] {
            let text = format!("// first{end}{end}sphere{end}{{ 0, \"{end}");
            for table in [false, true] {
                for file in both(&text) {
                    if table {
                        file.reader().lines();
                        file.span(text.len() as u32);
                    }
                    let place = |word| {
                        let start = text.find(word).unwrap() as u32;
                        let span = file.span(start);
                        (span.line, span.column, file.excerpt(start, span).text)
                    };
                    assert_eq!(place("sphere"), (3, 1, "sphere".to_owned()), "{end:?}");
                    assert_eq!(place("0"), (4, 3, "{ 0, \"".to_owned()), "{end:?}");
                    assert_eq!(file.span(text.len() as u32).line, 5, "{end:?}");
                }
            }
        }
    }

    #[test]
    fn of_long_lines_what_is_around_is_shown() {
        let text = format!(
            "box {{ 1 }}\n{} sphere {} \ncone",
            "-".repeat(9000),
            "+".repeat(9000)
        );
        for file in both(&text) {
            let start = text.find("sphere").unwrap() as u32;
            let span = file.span(start);
            assert_eq!((span.line, span.column, span.length), (2, 9002, 6));
            let shown = file.excerpt(start, span);
            let expected = format!("{} sphere {}", "-".repeat(79), "+".repeat(73));
            assert_eq!((shown.text.as_str(), shown.column), (expected.as_str(), 81));
            let start = text.find("cone").unwrap() as u32;
            assert_eq!(file.excerpt(start, file.span(start)).text, "cone");
        }
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
            for file in both(&text) {
                if with_table {
                    file.reader().lines();
                }
                let mut state = 1usize;
                for round in 0..1000 {
                    state = state.wrapping_mul(1_103_515_245).wrapping_add(12_345) % (1 << 31);
                    let near = if round % 3 == 0 { text.len() } else { 5000 };
                    let start = (state % near + round * 40) % (text.len() + 1);
                    let span = file.span(start as u32);
                    assert_eq!((span.line, span.column), place(start), "{start}");
                }
            }
        }
    }

    #[test]
    fn a_text_in_parts_has_the_same_tokens() {
        let object = "sphere { <1, -2.25, 3>, 4 /* a\n */ pigment { rgb <0, 1e-3, 0> } } // b\n";
        let mut text = object.repeat(300);
        text.push_str("mesh2 { vertex_vectors { 999");
        text.push_str(&", <1, 2, 3>".repeat(999));
        text.push_str("} } #if (1) #declare albedo = 3;");
        text.push_str(&object.repeat(300));
        text.push_str("#end box { 1, \"");
        text.push_str(&"long ".repeat(2000));
        text.push_str("\" } #while (0) sphere { \"open");
        let [tokens, other] = both(&text).map(|file| {
            let (mut symbols, mut begin, mut found) = (Symbols::new(), 0, vec![]);
            loop {
                let lexed = file.lex(begin, 100, &mut symbols, Lexed::default());
                found.push((lexed.tokens, lexed.strings, lexed.problems));
                match lexed.rest {
                    Some(rest) => begin = rest,
                    None => return found,
                }
            }
        });
        assert!(tokens.len() > 20 && tokens.last().is_some_and(|(_, _, p)| p.len() == 2));
        assert_eq!(tokens, other);
    }
}
