//! `strahl submit merge`: makes the pictures of a job.

use super::{open, word};
use crate::args::submit::MergeJobArgs;
use crate::args::{Cli, Command as Parsed};
use crate::output::say;
use crate::report::Failure;
use crate::target::{Target, check_folder};
use crate::terminal;
use clap::Parser;
use serde::{Deserialize, Serialize};
use std::io::ErrorKind;
use std::path::Path;
use std::process::{Command, Stdio};
use strahl::formats::image::{WriteOptions, write_bytes};
use strahl_farm::{Job, Merged, Movie};

/// A picture of a job.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Picture {
    pub(super) file: String,
    /// SHA-256 of the film, as `--stats` of `render` has it.
    pub(super) sha256: String,
}

/// What came out of the last merge, in `result.json` of the job folder.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Outcome {
    pub(super) complete: bool,
    pub(super) pictures: Vec<Picture>,
    pub(super) problems: Vec<String>,
}

/// Its file in the job folder.
pub(super) const OUTCOME: &str = "result.json";

/// The most problems that are printed; `result.json` has all.
const MOST_SHOWN: usize = 20;

/// Makes the pictures of a job of its tiles.
pub(super) fn merge(args: &MergeJobArgs) -> Result<(), Failure> {
    let (folder, mut job) = open(&args.job)?;
    if let Some(place) = &args.pictures {
        let moved = |file: &Path| place.join(file.file_name().unwrap_or_default());
        job.output = moved(&job.output);
        if let Some(movie) = &mut job.movie {
            movie.file = moved(&movie.file);
        }
    }
    check_folder(&job.output)?;
    let mut outcome = Outcome::default();
    for frame in 0..job.frames.len() {
        if args.openjd {
            let share = frame as f64 / job.frames.len() as f64;
            say!("openjd_progress: {:.1}", 100.0 * share);
        }
        match picture(&job, &folder, frame) {
            Ok(picture) => outcome.pictures.push(picture),
            Err(problems) => outcome.problems.extend(problems),
        }
    }
    outcome.complete = outcome.problems.is_empty();
    if outcome.complete
        && let Some(movie) = &job.movie
        && let Err(problem) = film(&job, movie)
    {
        outcome.problems.push(problem);
    }
    let mut json = serde_json::to_vec_pretty(&outcome).map_err(Failure::new)?;
    json.push(b'\n');
    write_bytes(folder.join(OUTCOME), &json).map_err(Failure::new)?;
    for problem in outcome.problems.iter().take(MOST_SHOWN) {
        terminal::line(&format!("error: {problem}"));
    }
    let made = outcome.pictures.len();
    if outcome.problems.is_empty() {
        let first = &outcome.pictures[0].file;
        match made {
            1 => say!("{first}: complete"),
            _ => say!("{first} and {} more: complete", made - 1),
        }
        if args.openjd {
            say!("openjd_progress: 100.0");
        }
        return Ok(());
    }
    let rest = outcome.problems.len().saturating_sub(MOST_SHOWN);
    let more = match rest {
        0 => String::new(),
        _ => format!(
            "{rest} more problems are in {}; ",
            folder.join(OUTCOME).display()
        ),
    };
    let are = match job.frames.len() {
        1 => "picture is",
        _ if made == 1 => "pictures is",
        _ => "pictures are",
    };
    let text = format!(
        "{more}{made} of {} {are} complete; `strahl submit resume {}` renders what is missing",
        job.frames.len(),
        word(&folder)
    );
    if args.openjd {
        say!(
            "openjd_fail: {}; {text}",
            outcome.problems[0].replace('\n', " ")
        );
    }
    Err(Failure::new(text))
}

/// Makes the picture of a frame.
fn picture(job: &Job, folder: &Path, frame: usize) -> Result<Picture, Vec<String>> {
    let merged = job.merge(folder, frame).map_err(|error| error.0)?;
    let file = job.picture(frame);
    write(job, &merged, &file).map_err(|failure| match failure {
        Failure::Message(text) => vec![text],
        _ => vec![format!("{} cannot be written", file.display())],
    })?;
    Ok(Picture {
        file: file.display().to_string(),
        sha256: merged.film.sha256(),
    })
}

fn write(job: &Job, merged: &Merged, file: &Path) -> Result<(), Failure> {
    let begin = ["strahl", "merge", "TILE", "--output", "PICTURE"].map(str::to_owned);
    let words = begin.into_iter().chain(job.picture_words.iter().cloned());
    let cli = Cli::try_parse_from(words).map_err(Failure::new)?;
    let Parsed::Merge(args) = &cli.command else {
        return Err(Failure::new("the job's manifest names another command"));
    };
    let options = WriteOptions {
        bit_depth: args.bit_depth,
        grayscale: args.grayscale,
        jpeg_quality: args.jpeg_quality,
        ..WriteOptions::default()
    };
    let target = Target::named(file, args.picture_format)?;
    let mut layers = strahl::layers(&merged.film);
    if !target.format().info().layers {
        layers.clear();
    }
    let mut metadata = strahl::metadata();
    metadata.extend(merged.notes.iter().cloned());
    target.write(&strahl::picture(&merged.film, &layers, metadata), &options)
}

/// Makes a film file of the pictures. Without ffmpeg there is a note and no film file.
fn film(job: &Job, movie: &Movie) -> Result<(), String> {
    let Some(first) = job.frames[0].number else {
        return Ok(());
    };
    let shown = movie.file.display();
    let picture = job.picture(0);
    let name = picture.file_name().unwrap_or_default().to_string_lossy();
    let number = format!("{first:0width$}", width = job.digits);
    // The number is the last thing before the ending.
    let pattern = match name.rfind(&number) {
        Some(at) => {
            let (before, after) = (&name[..at], &name[at + number.len()..]);
            let escaped = |text: &str| text.replace('%', "%%");
            format!("{}%0{}d{}", escaped(before), job.digits, escaped(after))
        }
        None => return Err(format!("{shown}: the pictures have no numbers")),
    };
    let temporary = movie.file.with_file_name(format!(
        ".{}-{}",
        std::process::id(),
        movie.file.file_name().unwrap_or_default().to_string_lossy()
    ));
    let output = Command::new("ffmpeg")
        .args([
            "-y",
            "-loglevel",
            "error",
            "-framerate",
            &movie.rate.to_string(),
        ])
        .args(["-start_number", &first.to_string(), "-i"])
        .arg(picture.with_file_name(&pattern))
        .args(["-pix_fmt", "yuv420p"])
        .arg(&temporary)
        .stdin(Stdio::null())
        .output();
    match output {
        Err(error) if error.kind() == ErrorKind::NotFound => {
            say!(
                "note: there is no {shown}, because ffmpeg is not installed here; on another machine: ffmpeg -framerate {} -start_number {first} -i {} -pix_fmt yuv420p {shown}",
                movie.rate,
                picture.with_file_name(&pattern).display()
            );
            Ok(())
        }
        Err(error) => Err(format!("{shown}: ffmpeg cannot be run: {error}")),
        Ok(output) if output.status.success() => {
            std::fs::rename(&temporary, &movie.file).map_err(|error| format!("{shown}: {error}"))
        }
        Ok(output) => {
            // ffmpeg's error is the one to report.
            let _ = std::fs::remove_file(&temporary);
            let said = String::from_utf8_lossy(&output.stderr);
            Err(format!("{shown}: ffmpeg failed: {}", said.trim()))
        }
    }
}
