//! The standard error: everything that the program prints there goes through this module.
//!
//! Texts of scenes may contain sequences that control a terminal, so control characters are printed as escapes. Errors are
//! coloured on a terminal, unless `NO_COLOR` is set.

use anstyle::{AnsiColor, Style};
use indicatif::ProgressBar;
use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::{IsTerminal, Write};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The incomplete parts of the screen.
struct Screen {
    /// The progress bar, which is hidden while lines are printed.
    bar: Option<ProgressBar>,
    /// A line of the scene's messages that has not ended yet.
    open: String,
}

static SCREEN: Mutex<Screen> = Mutex::new(Screen {
    bar: None,
    open: String::new(),
});

fn screen() -> MutexGuard<'static, Screen> {
    SCREEN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Registers a progress bar, which is hidden while lines are printed.
pub(crate) fn show_bar(bar: Option<ProgressBar>) {
    screen().bar = bar;
}

/// Whether the standard error is a terminal.
pub(crate) fn is_terminal() -> bool {
    std::io::stderr().is_terminal()
}

/// Prints a line of the program itself.
pub(crate) fn line(text: &str) {
    put(&mut screen(), &styled(&visible(text)));
}

/// Prints the last line before the program ends, even if another thread holds the lock.
pub(crate) fn last_line(text: &str) {
    match SCREEN.try_lock() {
        Ok(mut screen) => put(&mut screen, &styled(&visible(text))),
        // If this fails, there is no way left to report it.
        Err(_) => drop(writeln!(std::io::stderr(), "{}", visible(text))),
    }
}

/// Prints a message of a scene, which often has no line end.
pub(crate) fn message(text: &str) {
    let mut screen = screen();
    for part in text.split_inclusive('\n') {
        screen.open.push_str(part);
        if part.ends_with('\n') || screen.open.len() > 4096 {
            let line = std::mem::take(&mut screen.open);
            put(&mut screen, &visible(line.trim_end_matches('\n')));
        }
    }
}

/// Ends an open line of a scene.
pub(crate) fn end_line() {
    let mut screen = screen();
    if !screen.open.is_empty() {
        let line = std::mem::take(&mut screen.open);
        put(&mut screen, &visible(&line));
    }
}

/// Prints a line, after ending an open one.
fn put(screen: &mut Screen, text: &str) {
    let open = std::mem::take(&mut screen.open);
    let write = || {
        let mut out = anstream::stderr().lock();
        if !open.is_empty() {
            // An error here means that the standard error is closed, and can't be reported.
            let _ = writeln!(out, "{}", visible(&open));
        }
        let _ = writeln!(out, "{text}");
    };
    match &screen.bar {
        Some(bar) => bar.suspend(write),
        None => write(),
    }
}

/// The text with all characters escaped that could control a terminal or change the direction of text: `\x1b`, `\u{202e}`. Line
/// ends and tabs stay.
pub(crate) fn visible(text: &str) -> Cow<'_, str> {
    if !text.contains(is_hidden) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        match u32::from(c) {
            // Writing to a string never fails.
            n if is_hidden(c) && n < 0x100 => drop(write!(out, "\\x{n:02x}")),
            n if is_hidden(c) => drop(write!(out, "\\u{{{n:x}}}")),
            _ => out.push(c),
        }
    }
    Cow::Owned(out)
}

fn is_hidden(c: char) -> bool {
    let turns = matches!(
        c,
        '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{61c}'
    );
    turns || (c.is_control() && !matches!(c, '\n' | '\t'))
}

/// A diagnostic in colours: its kind and the caret in red or yellow, margins and arrows in blue, help in green. The stream
/// removes the colours if they are not wanted.
fn styled(text: &str) -> String {
    let mut lines = text.split('\n');
    let first = lines.next().unwrap_or_default();
    let kinds = [
        ("error", AnsiColor::Red),
        ("warning", AnsiColor::Yellow),
        ("note", AnsiColor::Cyan),
        ("interrupted", AnsiColor::Yellow),
    ];
    let kind = kinds.iter().find_map(|(word, color)| {
        let rest = first.strip_prefix(word)?;
        rest.starts_with([':', ';'])
            .then_some((*word, *color, rest))
    });
    let Some((word, color, rest)) = kind else {
        return text.to_owned();
    };
    let bold = Style::new().bold();
    let strong = bold.fg_color(Some(color.into()));
    let margin = bold.fg_color(Some(AnsiColor::Blue.into()));
    let help = bold.fg_color(Some(AnsiColor::Green.into()));
    let mut out = format!("{strong}{word}{strong:#}{bold}{rest}{bold:#}");
    for line in lines {
        out.push('\n');
        let indent = line.len() - line.trim_start().len();
        let (space, body) = line.split_at(indent);
        out.push_str(space);
        let number = body.find(|c: char| !c.is_ascii_digit()).unwrap_or(0);
        let (digits, behind) = body.split_at(number);
        // Writing to a string never fails.
        let _ = if let Some(place) = body.strip_prefix("--> ") {
            write!(out, "{margin}-->{margin:#} {place}")
        } else if let Some(advice) = body.strip_prefix("= help:") {
            write!(out, "{margin}={margin:#} {help}help{help:#}:{advice}")
        } else if let Some(source) = behind.strip_prefix('|').filter(|_| digits.is_empty()) {
            write!(out, "{margin}|{margin:#}{strong}{source}{strong:#}")
        } else if let Some(source) = behind.strip_prefix(" |") {
            write!(out, "{margin}{digits} |{margin:#}{source}")
        } else {
            write!(out, "{body}")
        };
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_commands_a_terminal_is_written_in_letters() {
        assert_eq!(visible("plain ä\tb\nc"), "plain ä\tb\nc");
        assert_eq!(visible("a\u{1b}[2Jb"), "a\\x1b[2Jb");
        assert_eq!(visible("\r\u{8}\u{7f}\u{9b}"), "\\x0d\\x08\\x7f\\x9b");
        assert_eq!(visible("x\u{202e}y\u{2066}"), "x\\u{202e}y\\u{2066}");
    }

    #[test]
    fn colours_add_nothing_but_colours() {
        let text = "error: `abc` is not a number\n  --> scene.nff:12:5\n   |\n12 | s 0 abc 1 2\n   |     ^^^\n  \
                    = in macro `M`, called at scene.nff:9:1\n  = help: write a number";
        let painted = styled(text);
        assert!(painted.contains("\u{1b}[1m") && painted.contains("\u{1b}[31m"));
        assert_eq!(anstream::adapter::strip_str(&painted).to_string(), text);
        assert_eq!(styled("a.png: 8x8"), "a.png: 8x8");
        assert_eq!(styled("errors are rare"), "errors are rare");
    }
}
