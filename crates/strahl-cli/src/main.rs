//! `strahl`: exact, explainable, reproducible recursive ray tracing on the command line.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "talking to the user is what a program is for"
)]

mod animation;
mod args;
mod commands;
mod explain;
mod fonts;
mod heat;
mod input;
mod interrupt;
mod output;
mod pov;
mod progress;
mod report;
mod stats;

use args::{Cli, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let words = match pov::translate(std::env::args_os().collect()) {
        Ok(translated) => translated,
        Err(problem) => {
            eprintln!("error: {problem}");
            return ExitCode::from(2);
        }
    };
    let cli = Cli::parse_from(words.words);
    if !matches!(&cli.command, Command::Render(args) if args.quiet) {
        for note in words.notes {
            eprintln!("note: {note}");
        }
    }
    let outcome = match &cli.command {
        Command::Render(args) => commands::render(args),
        Command::Explain(args) => commands::explain(args),
        Command::Compare(args) => commands::compare(args),
        Command::Heatmap(args) => commands::heatmap(args),
        Command::TraceRay(args) => commands::trace_ray(args),
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
