//! Hands jobs to Slurm and to Open Job Description.

use super::create::{Created, create};
use super::word;
use crate::args::submit::{OpenjdArgs, SlurmArgs};
use crate::report::{Failure, Reporter};
use serde::{Deserialize, Serialize};
use std::ffi::OsString;
use std::io::ErrorKind;
use std::path::Path;
use std::process::Command;
use strahl::formats::image::write_bytes;
use strahl_farm::slurm::{
    SlurmOptions, merge_command, merge_script, quoted, render_command, render_script,
};
use strahl_farm::{Job, openjd as template};

/// The numbers of a job in Slurm, in `slurm.json` of its folder.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct SlurmJob {
    pub(super) array: String,
    pub(super) merge: String,
}

/// Its file in the job folder.
pub(super) const SLURM_JOB: &str = "slurm.json";

/// `strahl submit slurm`.
pub(super) fn slurm(args: &SlurmArgs, words: &[OsString], notes: &[String]) -> Result<(), Failure> {
    let reporter = Reporter::new(args.render.quiet);
    reporter.notes(notes);
    let options = SlurmOptions {
        partition: args.partition.clone(),
        time: args.time.clone(),
        mem: args.mem.clone(),
        cpus: args.cpus,
        more: args.sbatch.clone(),
    };
    let program = match &args.program {
        Some(program) => program.clone(),
        None => std::env::current_exe().map_err(Failure::new)?,
    };
    let Created { folder, job } = create(
        "slurm",
        &args.parts,
        &args.render,
        words,
        args.chunk,
        |_, new, folder| {
            let write = |name: &str, text: &str| {
                write_bytes(new.join(name), text.as_bytes()).map_err(Failure::new)
            };
            write("render.sbatch", &render_script(&options, &program, folder))?;
            write("merge.sbatch", &merge_script(&options, &program, folder))
        },
    )?;
    say_parts(&reporter, &folder, &job);
    let tasks: Vec<u32> = (1..=job.tasks() as u32).collect();
    if args.parts.dry_run {
        reporter.say("not submitted (--dry-run); this would submit it:");
        reporter.say(&format!(
            "  sbatch {}",
            line(&render_command(&folder, &tasks))
        ));
        reporter.say(&format!("  sbatch {}", line(&merge_command(&folder, "ID"))));
        return reporter.settle();
    }
    let submitted = submit_slurm(&folder, &tasks)?;
    reporter.say(&format!(
        "Slurm job {} renders, job {} merges; `strahl submit status {}` tells how far they are",
        submitted.array,
        submitted.merge,
        word(&folder)
    ));
    reporter.settle()
}

/// `strahl submit openjd`.
pub(super) fn openjd(
    args: &OpenjdArgs,
    words: &[OsString],
    notes: &[String],
) -> Result<(), Failure> {
    let reporter = Reporter::new(args.render.quiet);
    reporter.notes(notes);
    let Created { folder, job } = create(
        "openjd",
        &args.parts,
        &args.render,
        words,
        None,
        |job, new, _| {
            let scene = job.scene.file_stem().unwrap_or_default().to_string_lossy();
            let template = template::template(job, &format!("strahl {scene}"));
            let mut json = serde_json::to_vec_pretty(&template).map_err(Failure::new)?;
            json.push(b'\n');
            std::fs::create_dir(new.join(template::PICTURES)).map_err(Failure::new)?;
            write_bytes(new.join("template.json"), &json).map_err(Failure::new)
        },
    )?;
    say_parts(&reporter, &folder, &job);
    let line = openjd_line(&folder, &job);
    reporter.say(&format!(
        "{line} runs it here, a step at a time; AWS Deadline Cloud takes the folder as a job bundle"
    ));
    reporter.settle()
}

/// The command that runs a job of Open Job Description on this machine.
pub(super) fn openjd_line(folder: &Path, job: &Job) -> String {
    let pictures = job.output.parent().unwrap_or(Path::new("/"));
    format!(
        "openjd run {} -p Pictures={}",
        word(&folder.join("template.json")),
        word(pictures)
    )
}

fn say_parts(reporter: &Reporter, folder: &Path, job: &Job) {
    let s = |n: usize| if n == 1 { "" } else { "s" };
    let (frames, tiles) = (job.frames.len(), job.tiles.len());
    let frames = match job.frames[0].number {
        None => String::new(),
        Some(_) => format!("{frames} frame{} in ", s(frames)),
    };
    reporter.say(&format!(
        "{}: {frames}{tiles} tile{}, {} task{}",
        folder.display(),
        s(tiles),
        job.tasks(),
        s(job.tasks())
    ));
}

/// Words as a line for a shell.
pub(super) fn line(words: &[String]) -> String {
    let words: Vec<String> = words.iter().map(|word| quoted(word)).collect();
    words.join(" ")
}

/// Submits tasks of a job and the merge behind them, and keeps their numbers.
pub(super) fn submit_slurm(folder: &Path, tasks: &[u32]) -> Result<SlurmJob, Failure> {
    let hint = |failure: Failure, hint: &str| match failure {
        Failure::Message(text) => Failure::Message(format!("{text}\n{hint}")),
        other => other,
    };
    let folder_word = word(folder);
    let array = sbatch(&render_command(folder, tasks)).map_err(|failure| {
        let text =
            format!("the job folder is complete: `strahl submit resume {folder_word}` submits it");
        hint(failure, &text)
    })?;
    let merge = sbatch(&merge_command(folder, &array)).map_err(|failure| {
        let text = format!("the tasks are submitted (job {array}), but not the merge: run `strahl submit merge {folder_word}` when they are done");
        hint(failure, &text)
    })?;
    let submitted = SlurmJob { array, merge };
    let json = serde_json::to_vec(&submitted).map_err(Failure::new)?;
    write_bytes(folder.join(SLURM_JOB), &json).map_err(Failure::new)?;
    Ok(submitted)
}

/// Runs sbatch; returns the number of the job.
fn sbatch(words: &[String]) -> Result<String, Failure> {
    let output = Command::new("sbatch").args(words).output().map_err(|error| match error.kind() {
        ErrorKind::NotFound => Failure::new(
            "there is no program sbatch: submit on a machine of the cluster, or add --dry-run and submit by hand",
        ),
        _ => Failure::new(format!("sbatch cannot be run: {error}")),
    })?;
    let text = String::from_utf8_lossy(&output.stdout);
    // On a cluster of clusters the name of the cluster follows.
    let number = text.trim().split(';').next().unwrap_or_default().to_owned();
    let is_number = !number.is_empty() && number.chars().all(|c| c.is_ascii_digit());
    match output.status.success() && is_number {
        true => Ok(number),
        false => {
            let said = String::from_utf8_lossy(&output.stderr);
            Err(Failure::new(format!(
                "sbatch {} failed: {}",
                line(words),
                said.trim()
            )))
        }
    }
}
