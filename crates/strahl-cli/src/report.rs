use crate::{interrupt, terminal};
use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::fmt::Display;
use std::sync::atomic::{AtomicBool, Ordering};
use strahl::scene::{Diagnostic, Severity, SourceMap};

/// The reason why a command failed.
#[derive(Debug)]
pub(crate) enum Failure {
    /// An error with this message.
    Message(String),
    /// Errors in the scene, whose diagnostics are already printed.
    Reported,
    /// Warnings, which `--strict` makes a failure.
    Strict(String),
    /// The user pressed Ctrl-C.
    Interrupted,
}

impl Failure {
    pub(crate) fn new(message: impl Display) -> Self {
        Self::Message(message.to_string())
    }

    pub(crate) fn print(&self) {
        match self {
            Self::Message(message) => terminal::line(&format!("error: {message}")),
            Self::Reported => {}
            Self::Strict(what) => terminal::line(&format!("error: {what} (--strict)")),
            Self::Interrupted => {
                if !interrupt::ends() {
                    // The thread that handles Ctrl-C is ending the program.
                    interrupt::wait();
                }
                interrupt::say(&interrupt::lost());
            }
        }
    }

    /// The exit code: 1 for errors, 3 for warnings with `--strict`, 130 for Ctrl-C, as shells report it. (2 is clap's, for wrong
    /// command lines.)
    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::Message(_) | Self::Reported => 1,
            Self::Strict(_) => 3,
            Self::Interrupted => 130,
        }
    }
}

/// Whether warnings are a failure: `--strict`, set once by `main`.
static STRICT: AtomicBool = AtomicBool::new(false);

/// Makes warnings a failure.
pub(crate) fn be_strict() {
    STRICT.store(true, Ordering::Relaxed);
}

/// Prints diagnostics. Each text is printed once, because the frames of an animation repeat them.
#[derive(Debug)]
pub(crate) struct Reporter {
    /// Print errors only.
    pub(crate) quiet: bool,
    said: RefCell<BTreeSet<String>>,
    warnings: Cell<usize>,
}

impl Reporter {
    pub(crate) fn new(quiet: bool) -> Self {
        Self {
            quiet,
            said: RefCell::default(),
            warnings: Cell::new(0),
        }
    }

    /// Prints a message of the scene at once.
    pub(crate) fn message(text: &str) {
        terminal::message(text);
    }

    /// Prints diagnostics; returns whether one of them is an error. Diagnostics of the compiler know their place, but not the
    /// text of the line: `sources` provides at least the name of the file.
    pub(crate) fn print(&self, diagnostics: &[Diagnostic], sources: Option<&SourceMap>) -> bool {
        terminal::end_line();
        for diagnostic in diagnostics {
            let warning = diagnostic.severity == Severity::Warning;
            let text = text(diagnostic, sources);
            if !self.said.borrow_mut().insert(text.clone()) {
                continue;
            }
            self.warnings
                .set(self.warnings.get() + usize::from(warning));
            if !(warning && self.quiet) {
                terminal::line(&text);
            }
        }
        diagnostics.iter().any(Diagnostic::is_error)
    }

    /// Counts diagnostics that are printed elsewhere.
    pub(crate) fn note(&self, diagnostics: &[Diagnostic]) {
        let warnings = diagnostics.iter().filter(|d| !d.is_error());
        self.warnings.set(self.warnings.get() + warnings.count());
    }

    /// Prints a line that is neither error nor warning.
    pub(crate) fn say(&self, text: &str) {
        if !self.quiet {
            terminal::line(text);
        }
    }

    /// Prints a warning of the program itself.
    pub(crate) fn warn(&self, text: &str) {
        self.print(&[Diagnostic::warning(text)], None);
    }

    /// Prints notes on settings that will have no effect.
    pub(crate) fn notes(&self, notes: &[String]) {
        for note in notes {
            self.say(&format!("note: {note}"));
        }
        self.warnings.set(self.warnings.get() + notes.len());
    }

    /// Returns a failure if there were warnings and `--strict` is set.
    pub(crate) fn settle(&self) -> Result<(), Failure> {
        match self.warnings.get() {
            n if n > 0 && STRICT.load(Ordering::Relaxed) => Err(Failure::Strict(format!(
                "there {} {n} warning{}",
                if n == 1 { "is" } else { "are" },
                if n == 1 { "" } else { "s" }
            ))),
            _ => Ok(()),
        }
    }
}

/// The text of a diagnostic.
fn text(diagnostic: &Diagnostic, sources: Option<&SourceMap>) -> String {
    let mut text = diagnostic.to_string();
    if diagnostic.source.is_none()
        && let Some(location) = sources.and_then(|s| s.locate(diagnostic.span))
    {
        text.push_str(&format!("\n  --> {location}"));
    }
    text
}
