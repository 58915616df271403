//! `strahl`: exact, explainable, reproducible recursive ray tracing on the command line.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "talking to the user is what a program is for"
)]

mod args;
mod commands;
mod explain;
mod input;
mod interrupt;
mod progress;
mod report;
mod stats;

use args::{Cli, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = Cli::parse();
    let outcome = match &cli.command {
        Command::Render(args) => commands::render(args),
        Command::Explain(args) => commands::explain(args),
        Command::Info(args) => commands::info(args),
        Command::Check(args) => commands::check(args),
        Command::Formats => commands::formats(),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.print();
            ExitCode::from(failure.code())
        }
    }
}
