//! Standard output.

use crate::report::Failure;
use crate::terminal::{self, visible};
use serde::Serialize;
use std::fmt::Arguments;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::Path;
use strahl::formats::image::write_bytes;

/// Prints a line on standard output. If the reader has closed it (`strahl explain ... | head`), the program ends without an
/// error.
pub(crate) fn line(text: Arguments<'_>) {
    let mut out = io::stdout().lock();
    // Names in scenes must not be able to control the terminal.
    let written = match out.is_terminal() {
        true => writeln!(out, "{}", visible(&text.to_string())),
        false => writeln!(out, "{text}"),
    };
    if let Err(error) = written {
        end(&error);
    }
}

/// Prints bytes on standard output.
pub(crate) fn bytes(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Ok(()) => Ok(()),
        Err(error) => end(&error),
    }
}

/// Writes a value as JSON to a file, or to the standard output if the file is `-`.
pub(crate) fn json(file: &Path, value: &impl Serialize) -> Result<(), Failure> {
    let mut json = serde_json::to_vec_pretty(value).map_err(Failure::new)?;
    json.push(b'\n');
    match is_standard(file) {
        true => bytes(&json),
        false => write_bytes(file, &json).map_err(Failure::new),
    }
}

/// Whether a file name means the standard output.
pub(crate) fn is_standard(file: &Path) -> bool {
    file.as_os_str() == "-"
}

/// Ends the program, because the output is closed or can't be written.
fn end(error: &io::Error) -> ! {
    let enough = error.kind() == ErrorKind::BrokenPipe;
    if !enough {
        terminal::line(&format!("error: the output cannot be written: {error}"));
    }
    #[expect(
        clippy::exit,
        reason = "the output can't be written, and no file is open"
    )]
    std::process::exit(i32::from(!enough))
}

/// Like `println!`, but a closed output is not an error.
macro_rules! say {
    ($($text:tt)*) => { $crate::output::line(format_args!($($text)*)) };
}
pub(crate) use say;
