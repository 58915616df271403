//! Standard output.

use std::fmt::Arguments;
use std::io::{ErrorKind, Write};

/// Prints a line on standard output. Who reads it may have enough (`strahl explain ... | head`): the program then ends, without a
/// complaint.
pub(crate) fn line(text: Arguments<'_>) {
    let mut out = std::io::stdout().lock();
    let Err(error) = writeln!(out, "{text}") else {
        return;
    };
    if error.kind() != ErrorKind::BrokenPipe {
        eprintln!("error: the output cannot be written: {error}");
    }
    #[expect(
        clippy::exit,
        reason = "nobody is left to print for, and no file is open"
    )]
    std::process::exit(i32::from(error.kind() != ErrorKind::BrokenPipe));
}

/// `println!` that survives a reader who has enough.
macro_rules! say {
    ($($text:tt)*) => { $crate::output::line(format_args!($($text)*)) };
}
pub(crate) use say;
