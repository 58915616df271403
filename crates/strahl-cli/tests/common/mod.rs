//! Functions for all tests of the program.

use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Runs the program in a folder, without standard input.
pub(crate) fn strahl(folder: &Path, args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_strahl"));
    command.current_dir(folder).args(args).stdin(Stdio::null());
    command.output().expect("the program starts")
}

/// The standard error of the program.
pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}
