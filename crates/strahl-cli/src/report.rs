use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fmt::Display;
use std::sync::atomic::{AtomicBool, Ordering};
use strahl::scene::{Diagnostic, Severity, SourceMap};

/// Why a command failed.
#[derive(Debug)]
pub(crate) enum Failure {
    /// One thing went wrong.
    Message(String),
    /// The scene is wrong; the diagnostics are printed already.
    Reported,
    /// The user pressed Ctrl-C; the text says what is lost and what is kept.
    Interrupted(String),
}

impl Failure {
    pub(crate) fn new(message: impl Display) -> Self {
        Self::Message(message.to_string())
    }

    pub(crate) fn print(&self) {
        match self {
            Self::Message(message) => eprintln!("error: {message}"),
            Self::Reported => {}
            Self::Interrupted(what) => eprintln!("interrupted; {what}"),
        }
    }

    /// Exit code: 1 for what went wrong, 130 as shells report Ctrl-C. (2 is clap's, for wrong command lines.)
    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::Message(_) | Self::Reported => 1,
            Self::Interrupted(_) => 130,
        }
    }
}

/// Whether the last message of a scene did not end its line.
static OPEN_LINE: AtomicBool = AtomicBool::new(false);

/// Prints diagnostics, each text once: the frames of an animation repeat them.
#[derive(Debug)]
pub(crate) struct Reporter {
    /// Print errors only.
    pub(crate) quiet: bool,
    said: RefCell<BTreeSet<String>>,
}

impl Reporter {
    pub(crate) fn new(quiet: bool) -> Self {
        Self {
            quiet,
            said: RefCell::default(),
        }
    }

    /// Prints what a scene says, as it comes.
    pub(crate) fn message(text: &str) {
        eprint!("{text}");
        if let Some(last) = text.chars().next_back() {
            OPEN_LINE.store(last != '\n', Ordering::Relaxed);
        }
    }

    /// Prints diagnostics and tells whether one of them is an error. Diagnostics of the compiler know their place, but not
    /// the text of the line: `sources` gives at least the name of the file.
    pub(crate) fn print(&self, diagnostics: &[Diagnostic], sources: Option<&SourceMap>) -> bool {
        for diagnostic in diagnostics {
            if self.quiet && diagnostic.severity == Severity::Warning {
                continue;
            }
            let mut text = diagnostic.to_string();
            if diagnostic.source.is_none()
                && let Some(location) = sources.and_then(|s| s.locate(diagnostic.span))
            {
                text.push_str(&format!("\n  --> {location}"));
            }
            if self.said.borrow_mut().insert(text.clone()) {
                // Scenes often leave their last line open.
                if OPEN_LINE.swap(false, Ordering::Relaxed) {
                    eprintln!();
                }
                eprintln!("{text}");
            }
        }
        diagnostics.iter().any(Diagnostic::is_error)
    }
}
