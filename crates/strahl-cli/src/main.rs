//! `strahl`: exact, explainable, reproducible recursive ray tracing on the command line.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "programs may print"
)]

mod animation;
mod args;
mod commands;
mod complete;
mod explain;
mod fonts;
mod heat;
mod input;
mod interrupt;
mod later;
mod memory;
mod output;
mod pov;
mod profile;
mod progress;
mod report;
mod stats;
mod submit;
mod target;
mod terminal;
mod tile;
mod words;
mod work;

use args::{Cli, Command};
use clap::{CommandFactory, FromArgMatches};
use report::Reporter;
use std::mem::ManuallyDrop;
use std::process::ExitCode;
use strahl::memory::{Bounded, use_large_pages};

/// Counts all memory of the program, for `--max-memory`.
#[global_allocator]
static MEMORY: Bounded = Bounded::new();

fn main() -> ExitCode {
    use_large_pages();
    if cfg!(panic = "abort") {
        end_after_panics();
    }
    // Making the description of the command line takes as long as tracing a thousand pixels, and so does dropping it.
    let mut command = ManuallyDrop::new(Cli::command());
    let translated = match pov::translate(std::env::args_os().collect(), &command) {
        Ok(translated) => translated,
        Err(problem) => {
            terminal::line(&format!("error: {problem}"));
            return ExitCode::from(2);
        }
    };
    let matches = command.try_get_matches_from_mut(&translated.words);
    let matches =
        matches.unwrap_or_else(|error| args::explained(error, &command, &translated.words).exit());
    let cli =
        Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.format(&mut command).exit());
    // The viewer ends by itself.
    if !matches!(cli.command, Command::View(_)) {
        interrupt::listen();
    }
    memory::bound(&MEMORY, cli.guard.max_memory);
    if cli.guard.strict {
        report::be_strict();
    }
    let outcome = match &cli.command {
        Command::Render(args) => {
            let reporter = Reporter::new(args.quiet);
            reporter.notes(&translated.notes);
            commands::render::run(args, reporter)
        }
        Command::Submit(command) => submit::submit(command, &translated.words, &translated.notes),
        Command::Merge(args) => commands::merge::run(args),
        Command::View(args) => commands::view::run(args),
        Command::Explain(args) => commands::explain::run(args),
        Command::Compare(args) => commands::compare::run(args),
        Command::Heatmap(args) => commands::heatmap::run(args),
        Command::TraceRay(args) => commands::trace_ray::run(args),
        Command::Info(args) => commands::info::run(args),
        Command::Check(args) => commands::check::run(args),
        Command::Formats => commands::formats::run(),
        Command::Completions { shell } => commands::completions::run(*shell),
        Command::Man { command } => commands::man::run(command),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.print();
            ExitCode::from(failure.code())
        }
    }
}

/// Adds to the message of a panic what the user can do, and ends the program with the exit code of panics that are not caught.
fn end_after_panics() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        usual(panic);
        terminal::last_line(
            "error: strahl itself has failed; please report this with the scene and the command",
        );
        interrupt::end(101);
    }));
}
