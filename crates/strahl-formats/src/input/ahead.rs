//! Reading ahead: all threads parse parts of a text before the sequential reader, which joins them, arrives there.
//!
//! A text is cut at line ends, and every part is parsed from its first statement on, by a function that does not know the text
//! before it. Meanwhile the reader goes through the statements one after the other, and takes a [`Piece`] wherever a statement
//! begins at exactly the byte where the piece does. So it makes no difference how the text is cut: a part that begins within a
//! statement is never used, and where a piece ends early (at an error, say) the reader parses the text itself. Line numbers in
//! pieces are exact, because lines are counted first.

use super::report::Fallible;
use super::text::Words;
use memchr::{memchr_iter, memrchr_iter};
use rayon::{Scope, Yield};
use std::cmp::Ordering;
use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
#[cfg(test)]
use {super::Input, super::Report, strahl_scene::Scene};

/// Bytes of a part: what is made of it stays in the cache of a core. Fuzzers' texts are short, and shall be cut too.
const PART: usize = if cfg!(fuzzing) { 64 } else { 1 << 20 };

/// Parts that are parsed at the same time; their results wait in memory.
const AT_ONCE: usize = 32;

/// Statements that have been parsed.
#[derive(Debug)]
pub(crate) struct Piece<'a, T> {
    /// The byte where the first of them begins.
    pub(crate) start: usize,
    /// The result of parsing them.
    pub(crate) content: T,
    /// The text behind the last of them.
    pub(crate) rest: Words<'a>,
}

/// A parser of single statements.
pub(crate) trait Statements<'a> {
    /// Its position in the text.
    fn words(&mut self) -> &mut Words<'a>;

    /// Parses the next statement. An erroneous one leaves no trace.
    fn statement(&mut self) -> Fallible<()>;
}

/// Parses the statements that begin before `end`, up to the first erroneous one. The first of them is next.
///
/// Returns where it begins and the text behind the last one, if there was any.
pub(crate) fn read_statements<'a>(
    parser: &mut impl Statements<'a>,
    end: usize,
) -> Option<(usize, Words<'a>)> {
    parser.words().advance();
    let start = parser.words().position();
    let mut rest = parser.words().clone();
    while parser.words().advance() && parser.words().position() < end {
        if parser.statement().is_err() {
            break;
        }
        rest = parser.words().clone();
    }
    (rest.position() > start).then_some((start, rest))
}

/// The pieces of a text.
#[derive(Debug)]
pub(crate) struct Ahead<'a, T> {
    part: usize,
    /// The results of the parts that are being parsed, in the order of the text.
    parts: VecDeque<Receiver<Option<Piece<'a, T>>>>,
    /// The next piece, if it has been parsed.
    next: Option<Piece<'a, T>>,
    /// The end of the parts so far, and the line there.
    until: usize,
    line: u32,
}

impl<T> Default for Ahead<'_, T> {
    fn default() -> Self {
        Self::with_part(PART)
    }
}

impl<'a, T> Ahead<'a, T> {
    /// Parts of this many bytes.
    pub(crate) fn with_part(part: usize) -> Self {
        Self {
            part,
            parts: VecDeque::new(),
            next: None,
            until: 0,
            line: 0,
        }
    }

    /// The piece that begins with the first statement of `words`, which is next.
    ///
    /// `read` is given the words from the start of a line or a statement on, and where its part ends: it passes
    /// over what is no beginning of a statement, and reads the statements that begin before the end of the part. It
    /// stops early, or makes no piece at all, as soon as a statement isn't one for it.
    pub(crate) fn piece<'scope>(
        &mut self,
        scope: &Scope<'scope>,
        words: &Words<'a>,
        read: impl Fn(Words<'a>, usize) -> Option<Piece<'a, T>> + Copy + Send + 'scope,
    ) -> Option<Piece<'a, T>>
    where
        'a: 'scope,
        T: Send + 'scope,
    {
        let at = words.position();
        if at >= self.until {
            self.parts.clear();
            (self.until, self.line) = (at, words.line());
        }
        let text = words.text();
        while self.parts.len() < AT_ONCE && self.until < text.len() {
            let (start, line) = (self.until, self.line);
            let end = part_end(text, start, self.part);
            self.until = end;
            self.line = line.saturating_add(lines_in(text, start, end));
            let part = words.from(start, line);
            let (sender, receiver) = sync_channel(1);
            // Nobody listens any more if the reader has given up.
            let task = move || sender.send(read(part, end)).unwrap_or(());
            if end == text.len() && self.parts.is_empty() {
                // Probably the whole text, which needs no threads.
                task();
            } else {
                scope.spawn(move |_| task());
            }
            self.parts.push_back(receiver);
        }
        loop {
            let piece = match self.next.take() {
                Some(piece) => piece,
                None => match wait(&self.parts.pop_front()?) {
                    Some(piece) => piece,
                    None => continue,
                },
            };
            match piece.start.cmp(&at) {
                Ordering::Less => {}
                Ordering::Equal => return Some(piece),
                Ordering::Greater => {
                    self.next = Some(piece);
                    return None;
                }
            }
        }
    }
}

/// Waits for a piece. A thread of the pool helps meanwhile, because otherwise all of them might be waiting.
fn wait<T>(part: &Receiver<Option<T>>) -> Option<T> {
    loop {
        match part.try_recv() {
            Ok(piece) => return piece,
            // The task has panicked, as the scope will at its end.
            Err(TryRecvError::Disconnected) => return None,
            Err(TryRecvError::Empty) => {}
        }
        match rayon::yield_now() {
            Some(Yield::Executed) => {}
            Some(Yield::Idle) => std::thread::yield_now(),
            None => return part.recv().ok()?,
        }
    }
}

/// Where the part from `start` on ends: behind the last line end within `length` bytes that no backslash takes back, or
/// else behind the first one after them.
fn part_end(text: &[u8], start: usize, length: usize) -> usize {
    let middle = start.saturating_add(length).min(text.len());
    if middle == text.len() {
        return middle;
    }
    let ends_line = |at: &usize| {
        let line = &text[..*at];
        !line.strip_suffix(b"\r").unwrap_or(line).ends_with(b"\\")
    };
    memrchr_iter(b'\n', &text[start..middle])
        .map(|i| start + i)
        .find(ends_line)
        .or_else(|| {
            memchr_iter(b'\n', &text[middle..])
                .map(|i| middle + i)
                .find(ends_line)
        })
        .map_or(text.len(), |i| i + 1)
}

/// The line ends (LF, CR LF or CR) from `start` to `end`, where a line begins.
fn lines_in(text: &[u8], start: usize, end: usize) -> u32 {
    let part = &text[start..end];
    let single = memchr_iter(b'\r', part).filter(|i| part.get(i + 1) != Some(&b'\n'));
    let count = memchr_iter(b'\n', part).count() + single.count();
    u32::try_from(count).unwrap_or(u32::MAX)
}

/// Reads a text in parts of several sizes.
///
/// # Panics
/// If scene or diagnostics differ from those of the text as one part.
#[cfg(test)]
pub(crate) fn assert_parts_make_no_difference<T>(
    text: &str,
    read: for<'a> fn(&'a Input<'a>, &mut Report, Ahead<'a, T>) -> Scene,
) {
    let loaded = |part| {
        let input = Input {
            bytes: text.as_bytes(),
            name: "test",
            folder: None,
        };
        let mut report = Report::default();
        let scene = read(&input, &mut report, Ahead::with_part(part));
        let (failed, diagnostics) = report.finish();
        let said: Vec<_> = diagnostics.iter().map(ToString::to_string).collect();
        let scene = (!failed).then_some(scene);
        format!("{}\n{scene:#?}", said.join("\n"))
    };
    let whole = loaded(usize::MAX);
    for part in [1, 17, 60, 200] {
        assert_eq!(loaded(part), whole, "parts of {part} bytes");
    }
}
