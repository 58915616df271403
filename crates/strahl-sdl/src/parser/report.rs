use super::{Entry, Parser, Place};
use crate::lexer::LexProblem;
use crate::suggest::{self, Candidate};
use crate::symbol::Symbol;
use crate::token::{Kind, Token};
use std::borrow::Cow;
use strahl_scene::{Diagnostic, Severity};

/// An error has been reported; the statement in which it happened is abandoned.
///
/// Only the reporting functions of [`Parser`] create one, so no error can go unreported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Failed(());

/// The result of parsing a part of the scene.
pub type PResult<T> = Result<T, Failed>;

impl Parser<'_> {
    /// Reports an error.
    pub fn fail(&mut self, place: Place, message: impl Into<String>) -> Failed {
        self.fail_with(place, Diagnostic::error(message))
    }

    /// Reports an error with advice.
    pub fn fail_hint(
        &mut self,
        place: Place,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) -> Failed {
        self.fail_with(place, Diagnostic::error(message).hint(hint))
    }

    /// Reports an error after which parsing ends.
    pub(crate) fn fail_fatally(
        &mut self,
        place: Place,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) -> Failed {
        let failed = self.fail_hint(place, message, hint);
        self.fatal = true;
        failed
    }

    /// Reports an error with its place, source line and trace.
    pub(crate) fn fail_with(&mut self, place: Place, diagnostic: Diagnostic) -> Failed {
        if !self.fatal {
            self.errors += usize::from(self.report(place, diagnostic));
            self.failures += 1;
            let limit = self.options.limits.errors;
            // Repeated errors are reported once, but a loop of errors must end too.
            self.fatal |= self.errors >= limit || self.failures >= limit.saturating_mul(10);
        }
        Failed(())
    }

    /// A failure that follows from an error already reported.
    fn fail_again(&mut self) -> Failed {
        self.failures += 1;
        self.fatal |= self.failures >= self.options.limits.errors.saturating_mul(10);
        Failed(())
    }

    /// Reports a warning; each text once per place.
    pub fn warn(&mut self, place: Place, message: impl Into<String>) {
        self.report(place, Diagnostic::warning(message));
    }

    /// Reports a warning with advice.
    pub fn warn_hint(&mut self, place: Place, message: impl Into<String>, hint: impl Into<String>) {
        self.report(place, Diagnostic::warning(message).hint(hint));
    }

    /// Adds a diagnostic; returns `false` if the same message was reported for the same place before, as in loops.
    fn report(&mut self, place: Place, mut diagnostic: Diagnostic) -> bool {
        const WARNINGS: usize = 200;
        /// The same warning is shown at this many places; the others are counted.
        const PLACES: usize = 3;
        if self.is_known(place, &diagnostic) {
            return false;
        }
        let span = self.span_at(place);
        if diagnostic.severity == Severity::Warning {
            let places = self.warned.entry(diagnostic.message.clone()).or_default();
            places.insert((place.file, place.start));
            if places.len() > PLACES || self.diagnostics.len() >= WARNINGS {
                return false;
            }
        }
        diagnostic = diagnostic.at(span);
        if let Some(chunk) = self.sources.get(place.file as usize) {
            diagnostic.source = Some(chunk.source.excerpt(place.start, span));
        }
        for step in self.trace() {
            diagnostic = diagnostic.traced(step);
        }
        self.diagnostics.push(diagnostic);
        true
    }

    /// Whether the same message was reported for the same place before.
    fn is_known(&self, place: Place, diagnostic: &Diagnostic) -> bool {
        let span = self.span_at(place);
        let same = |d: &Diagnostic| d.span == span && d.message == diagnostic.message;
        self.diagnostics.iter().any(same)
    }

    /// The macros and includes around the position, innermost first.
    fn trace(&self) -> Vec<String> {
        /// Of a deep recursion, only this many calls at both ends are shown.
        const SHOWN: usize = 8;
        let mut steps = vec![];
        for frame in self.frames.iter().rev() {
            let span = self.span_at(frame.from);
            let from = self.scene.sources.locate(span);
            let from = from.map_or(String::new(), |l| l.to_string());
            match frame.entry {
                Entry::Scene => {}
                Entry::Include => steps.push(format!("included at {from}")),
                Entry::Macro(name) => {
                    let name = self.symbols.text(name);
                    steps.push(format!("in macro `{name}`, called at {from}"));
                }
            }
        }
        if steps.len() > SHOWN {
            let left_out = steps.len() - SHOWN;
            steps.splice(
                SHOWN / 2..steps.len() - SHOWN / 2,
                [format!("... and {left_out} more ...")],
            );
        }
        steps
    }

    /// Reports a token other than the expected ones.
    pub fn unexpected(&mut self, token: Token, expected: &str) -> Failed {
        let place = self.place_of(token);
        if let (Kind::Name, Some(symbol)) = (token.kind, token.symbol()) {
            return match self.scopes.find(symbol) {
                None => self.undeclared(symbol, place, expected),
                Some(value) => {
                    let is = value.describe();
                    let name = shortened(self.symbols.text(symbol));
                    let message = format!("expected {expected}, found `{name}`, which is {is}");
                    self.fail(place, message)
                }
            };
        }
        let found = self.describe(token);
        self.fail(place, format!("expected {expected}, found {found}"))
    }

    /// Reports an undeclared name once: errors that follow from it are not reported.
    pub(crate) fn undeclared(&mut self, symbol: Symbol, place: Place, expected: &str) -> Failed {
        if !self.doubtful.insert(symbol) {
            return self.fail_again();
        }
        let name = shortened(self.symbols.text(symbol)).into_owned();
        let mut diagnostic = Diagnostic::error(format!(
            "expected {expected}, found the undeclared name `{name}`"
        ));
        // Loops repeat the error, and finding advice takes time.
        if !self.is_known(place, &diagnostic)
            && let Some(hint) = self.advice_for(&name)
        {
            diagnostic = diagnostic.hint(hint);
        }
        self.fail_with(place, diagnostic)
    }

    /// A suggestion for a misspelt name.
    fn advice_for(&self, name: &str) -> Option<String> {
        if let Some(file) = crate::include::declaring(name) {
            return Some(format!(
                "`{name}` is declared in {file}: write `#include \"{file}\"` first"
            ));
        }
        let bound = self.scopes.bound().map(|s| self.symbols.text(s));
        // Of equally close candidates, a declared name wins. A misspelt name with a capital letter is compared with the names of include
        // files before keywords, another one after them.
        let here = bound.map(|known| (Candidate::new(known), None));
        let is_name = name.starts_with(|c: char| c.is_ascii_uppercase());
        let (close, file) = if is_name {
            let known = crate::include::known_names().chain(crate::include::known_words());
            suggest::closest(name, here.chain(known))?
        } else {
            let known = crate::include::known_words().chain(crate::include::known_names());
            suggest::closest(name, here.chain(known))?
        };
        Some(match file {
            Some(file) => {
                format!(
                    "did you mean `{close}`? It is declared in {file}: write `#include \"{file}\"` first"
                )
            }
            None => format!("did you mean `{close}`?"),
        })
    }

    /// A token for messages.
    pub(crate) fn describe(&self, token: Token) -> String {
        match (token.kind, token.symbol()) {
            (Kind::Number, _) => format!("the number {}", token.number()),
            (Kind::String, _) => format!("the string \"{}\"", shortened(&self.string_of(token))),
            (Kind::Word, Some(s)) => format!("`{}`", self.symbols.text(s)),
            (Kind::Name, Some(s)) => format!("the name `{}`", shortened(self.symbols.text(s))),
            (Kind::Unknown, _) => match token.bits as u8 {
                b if b.is_ascii_graphic() => format!("`{}`", char::from(b)),
                b => format!("the byte 0x{b:02x}"),
            },
            (kind, _) => kind.describe().to_owned(),
        }
    }

    pub(super) fn report_lexing(&mut self, file: u32, problems: Vec<LexProblem>) {
        for problem in problems {
            let place = Place {
                file,
                start: problem.start,
            };
            self.fail_hint(place, problem.message, problem.hint);
        }
    }

    /// Whether parsing has ended early.
    pub(crate) fn is_fatal(&self) -> bool {
        self.fatal
    }

    /// All diagnostics, and whether one of them is an error.
    pub(crate) fn take_diagnostics(&mut self) -> (Vec<Diagnostic>, bool) {
        let mut diagnostics = std::mem::take(&mut self.diagnostics);
        for (message, places) in std::mem::take(&mut self.warned) {
            let same =
                |d: &&mut Diagnostic| d.severity == Severity::Warning && d.message == message;
            let shown = diagnostics.iter_mut().filter(|d| same(d)).count();
            let more = places.len().saturating_sub(shown);
            if more > 0
                && let Some(last) = diagnostics.iter_mut().rfind(same)
            {
                let s = if more == 1 { "" } else { "s" };
                last.hints.push(format!("the same at {more} more place{s}"));
            }
        }
        (diagnostics, self.errors > 0)
    }
}

/// A name or text of the scene for messages; a very long one is truncated.
pub(crate) fn shortened(text: &str) -> Cow<'_, str> {
    const SHOWN: usize = 200;
    match text.char_indices().nth(SHOWN) {
        None => Cow::Borrowed(text),
        Some((end, _)) => Cow::Owned(format!("{}...", text.get(..end).unwrap_or(""))),
    }
}
