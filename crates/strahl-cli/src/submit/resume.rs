//! `strahl submit resume`: submits what is missing.

use super::engine::{SLURM_JOB, SlurmJob, line, openjd_line, submit_slurm};
use super::status::states;
use super::{open, word};
use crate::args::submit::ResumeArgs;
use crate::output::say;
use crate::report::Failure;
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;
use strahl_farm::slurm::{folder_of, render_command};
use strahl_farm::{Care, Progress, ranges};

/// Submits the tasks of a job that have parts which are not done, and a merge behind them.
pub(super) fn resume(args: &ResumeArgs) -> Result<(), Failure> {
    let (folder, job) = open(&args.job)?;
    // As carefully as the merge will read them, which would refuse a damaged tile.
    let states = states(&job, &folder, Care::Whole);
    let open_parts = states
        .iter()
        .filter(|(_, progress)| !matches!(progress, Progress::Done(_)));
    let tasks: BTreeSet<u32> = open_parts
        .map(|(unit, _)| job.task_of(*unit) as u32)
        .collect();
    let tasks: Vec<u32> = tasks.into_iter().collect();
    if tasks.is_empty() {
        say!(
            "all parts are done: `strahl submit merge {}` makes the pictures",
            word(&folder)
        );
        return Ok(());
    }
    let script = folder.join("render.sbatch");
    if !script.is_file() {
        say!(
            "{} of {} tasks are left; run the job again, parts that are done are not rendered twice:\n  {}",
            tasks.len(),
            job.tasks(),
            openjd_line(&folder, &job)
        );
        return Ok(());
    }
    let text = std::fs::read_to_string(&script).map_err(Failure::new)?;
    // By any of its names: there may be symbolic links.
    let named = folder_of(&text).and_then(|place| place.canonicalize().ok());
    if named.as_deref() != Some(&*folder) {
        return Err(Failure::new(format!(
            "{} was moved after it was submitted, and its scripts name its old place: move it back, or submit the job again",
            folder.display()
        )));
    }
    if args.dry_run {
        say!("sbatch {}", line(&render_command(&folder, &tasks)));
        return Ok(());
    }
    if let Some(known) = submitted(&folder)
        && in_queue(&known)
    {
        return Err(Failure::new(format!(
            "the job is still in the queue: wait for it, or end it with `scancel {} {}`",
            known.array, known.merge
        )));
    }
    let new = submit_slurm(&folder, &tasks)?;
    let (s, list) = (if tasks.len() == 1 { "" } else { "s" }, ranges(&tasks));
    say!(
        "task{s} {list}: Slurm job {} renders, job {} merges",
        new.array,
        new.merge
    );
    Ok(())
}

/// The numbers of the job in Slurm, if it was submitted.
fn submitted(folder: &Path) -> Option<SlurmJob> {
    serde_json::from_slice(&std::fs::read(folder.join(SLURM_JOB)).ok()?).ok()
}

/// Whether Slurm still has tasks of the job. Jobs that it has forgotten are over.
fn in_queue(job: &SlurmJob) -> bool {
    let output = Command::new("squeue")
        .args(["--noheader", "--format=%T", "--jobs", &job.array])
        .output();
    output.is_ok_and(|output| {
        let text = String::from_utf8_lossy(&output.stdout);
        output.status.success() && text.lines().any(|line| !line.trim().is_empty())
    })
}
