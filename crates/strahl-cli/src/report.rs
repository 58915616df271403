use std::fmt::Display;
use strahl::scene::{Diagnostic, Severity, SourceMap};

/// Why a command failed.
#[derive(Debug)]
pub(crate) enum Failure {
    /// One thing went wrong.
    Message(String),
    /// The scene is wrong; the diagnostics are printed already.
    Reported,
    /// The user pressed Ctrl-C.
    Interrupted,
}

impl Failure {
    pub(crate) fn new(message: impl Display) -> Self {
        Self::Message(message.to_string())
    }

    pub(crate) fn print(&self) {
        match self {
            Self::Message(message) => eprintln!("error: {message}"),
            Self::Reported => {}
            Self::Interrupted => eprintln!("interrupted; nothing was written"),
        }
    }

    /// Exit code: 1 for what went wrong, 130 as shells report Ctrl-C. (2 is clap's, for wrong command lines.)
    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::Message(_) | Self::Reported => 1,
            Self::Interrupted => 130,
        }
    }
}

/// Prints diagnostics and tells whether one of them is an error. Diagnostics of the compiler know their place, but not the
/// text of the line: `sources` gives at least the name of the file.
pub(crate) fn print_diagnostics(
    diagnostics: &[Diagnostic],
    sources: Option<&SourceMap>,
    quiet: bool,
) -> bool {
    for diagnostic in diagnostics {
        if quiet && diagnostic.severity == Severity::Warning {
            continue;
        }
        eprintln!("{diagnostic}");
        if diagnostic.source.is_none()
            && let Some(location) = sources.and_then(|s| s.locate(diagnostic.span))
        {
            eprintln!("  --> {location}");
        }
    }
    diagnostics.iter().any(Diagnostic::is_error)
}
