use crate::Span;
use std::fmt;

/// The severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The picture is as requested, but something deserves attention.
    Warning,
    /// There can be no correct picture.
    Error,
}

/// The line of text a diagnostic points into.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceLine {
    /// Name of the file, as shown to the user.
    pub file: String,
    /// The text of the line, without its end; long lines are shortened to the part around the place.
    pub text: String,
    /// Column (1-based, in characters of `text`) where the caret goes.
    pub column: u32,
    /// Number of characters underlined, at least 1.
    pub length: u32,
}

/// A message about a scene: what was found, what was expected, where, and what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Error or warning.
    pub severity: Severity,
    /// What is wrong, as a sentence without a full stop.
    pub message: String,
    /// Where; [`Span::NONE`] if it concerns no place in particular.
    pub span: Span,
    /// The line it points into, if the text is available.
    pub source: Option<SourceLine>,
    /// What to do about it.
    pub hints: Vec<String>,
    /// The macros and include files around the place, innermost first.
    pub trace: Vec<String>,
}

impl Diagnostic {
    /// An error without a place.
    pub fn error(message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            message: message.into(),
            span: Span::NONE,
            source: None,
            hints: vec![],
            trace: vec![],
        }
    }

    /// A warning without a place.
    pub fn warning(message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Warning,
            ..Self::error(message)
        }
    }

    /// Sets the place.
    #[must_use]
    pub fn at(self, span: Span) -> Self {
        Self { span, ..self }
    }

    /// Shows the line it points into: column and length are taken from the span, which must be set before.
    #[must_use]
    pub fn with_source(mut self, file: &str, line: &str) -> Self {
        const SHOWN: usize = 160;
        let column = self.span.column.max(1) as usize;
        // Very long lines (exporters write them) are cut around the place.
        let skip = column.saturating_sub(SHOWN / 2);
        let text: String = line.chars().skip(skip).take(SHOWN).collect();
        let shown = text.chars().count().max(1);
        let column = (column - skip).min(shown + 1) as u32;
        let length = self
            .span
            .length
            .max(1)
            .min((shown as u32 + 1).saturating_sub(column).max(1));
        self.source = Some(SourceLine {
            file: file.to_owned(),
            text,
            column,
            length,
        });
        self
    }

    /// Adds a piece of advice.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hints.push(hint.into());
        self
    }

    /// Adds a macro or include file outside of those already given.
    #[must_use]
    pub fn traced(mut self, step: impl Into<String>) -> Self {
        self.trace.push(step.into());
        self
    }

    /// Whether it is an error.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

impl fmt::Display for Diagnostic {
    /// Message, place, line with caret, trace, hints: plain text without colours.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = match self.severity {
            Severity::Warning => "warning",
            Severity::Error => "error",
        };
        write!(f, "{kind}: {}", self.message)?;
        if let Some(source) = &self.source {
            let number = if self.span.is_some() {
                self.span.line.to_string()
            } else {
                String::new()
            };
            let margin = " ".repeat(number.len());
            write!(f, "\n{margin}--> {}", source.file)?;
            if self.span.is_some() {
                write!(f, ":{}", self.span.line)?;
                if self.span.column > 0 {
                    write!(f, ":{}", self.span.column)?;
                }
                // Tabs would shift the caret, control characters would disturb the terminal.
                let text: String = source
                    .text
                    .chars()
                    .map(|c| if c.is_control() { ' ' } else { c })
                    .collect();
                let indent = " ".repeat(source.column.saturating_sub(1) as usize);
                let carets = "^".repeat(source.length as usize);
                write!(
                    f,
                    "\n{margin} |\n{number} | {text}\n{margin} | {indent}{carets}"
                )?;
            }
        }
        for step in &self.trace {
            write!(f, "\n  = {step}")?;
        }
        for hint in &self.hints {
            write!(f, "\n  = help: {hint}")?;
        }
        Ok(())
    }
}

/// All errors of a scene as one error.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problems(pub Vec<Diagnostic>);

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, problem) in self.0.iter().enumerate() {
            let end = if i > 0 { "\n" } else { "" };
            write!(f, "{end}{problem}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Problems {}

impl From<Vec<Diagnostic>> for Problems {
    fn from(all: Vec<Diagnostic>) -> Self {
        Self(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FileId;

    #[test]
    fn the_caret_stands_under_the_place() {
        let span = Span {
            file: FileId(0),
            line: 12,
            column: 5,
            length: 3,
        };
        let text = Diagnostic::error("`abc` is not a number")
            .at(span)
            .with_source("scene.nff", "s 0 abc 1 2")
            .traced("in macro `M`, called at scene.nff:9:1")
            .hint("write a decimal number such as `0.5`")
            .to_string();
        let expected = "error: `abc` is not a number\n  --> scene.nff:12:5\n   |\n12 | s 0 abc 1 2\n   |     ^^^\n  \
                        = in macro `M`, called at scene.nff:9:1\n  = help: write a decimal number such as `0.5`";
        assert_eq!(text, expected);
    }

    #[test]
    fn long_lines_are_cut_around_the_place() {
        let line = "x".repeat(1000);
        let span = Span {
            file: FileId(0),
            line: 1,
            column: 900,
            length: 5000,
        };
        let diagnostic = Diagnostic::error("too long")
            .at(span)
            .with_source("a", &line);
        let source = diagnostic.source.as_ref().expect("given");
        assert!(source.text.len() <= 160 && source.column + source.length <= 162);
        assert!(
            diagnostic
                .to_string()
                .lines()
                .all(|l| l.chars().count() < 180)
        );
    }

    #[test]
    fn an_empty_line_and_control_characters_are_harmless() {
        let span = Span {
            file: FileId(0),
            line: 1,
            column: 1,
            length: 1,
        };
        assert!(
            Diagnostic::error("x")
                .at(span)
                .with_source("a", "")
                .to_string()
                .ends_with('^')
        );
        let shown = Diagnostic::error("x")
            .at(span)
            .with_source("a", "a\tb\u{1b}[2J")
            .to_string();
        assert!(!shown.contains('\u{1b}') && !shown.contains('\t'));
    }
}
