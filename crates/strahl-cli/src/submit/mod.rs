//! `strahl submit`: pictures and films for clusters and render farms.

mod create;
mod engine;
mod merge;
mod resume;
mod status;
mod task;

use crate::args::submit::SubmitCommand;
use crate::report::Failure;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use strahl_farm::Job;
use strahl_farm::slurm::quoted;

/// `strahl submit`: `words` is the whole command line, of which a job keeps what concerns its tasks.
pub(crate) fn submit(
    command: &SubmitCommand,
    words: &[OsString],
    notes: &[String],
) -> Result<(), Failure> {
    match command {
        SubmitCommand::Slurm(args) => engine::slurm(args, words, notes),
        SubmitCommand::Openjd(args) => engine::openjd(args, words, notes),
        SubmitCommand::Status(args) => status::status(args),
        SubmitCommand::Resume(args) => resume::resume(args),
        SubmitCommand::Task(args) => task::task(args),
        SubmitCommand::Merge(args) => merge::merge(args),
    }
}

/// A path as a word of a shell, for commands that are shown.
fn word(path: &Path) -> String {
    quoted(&path.display().to_string())
}

/// A job folder, by its full path, and its manifest.
fn open(folder: &Path) -> Result<(PathBuf, Job), Failure> {
    let job = Job::read(folder).map_err(Failure::new)?;
    let folder = folder.canonicalize().map_err(Failure::new)?;
    Ok((folder, job))
}
