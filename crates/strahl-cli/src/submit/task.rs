//! `strahl submit task`: renders parts of a job.

use super::open;
use crate::args::submit::TaskArgs;
use crate::args::{Cli, Command};
use crate::input::Kept;
use crate::output::say;
use crate::report::{Failure, Reporter};
use crate::{commands, terminal, tile};
use clap::Parser;
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::thread::JoinHandle;
use std::time::Instant;
use strahl_farm::{Care, Job, State, Unit};

/// Renders the parts of a task, one after the other. Parts that are complete already are left alone, so a task that is run again, or twice
/// at once, does no harm.
pub(super) fn task(args: &TaskArgs) -> Result<(), Failure> {
    let (folder, job) = open(&args.job)?;
    job.check_program(tile::VERSION).map_err(Failure::new)?;
    let units = units(args, &job)?;
    if !job.bundled {
        std::env::set_current_dir(&job.folder).map_err(|error| {
            Failure::new(format!("cannot go to {}: {error}", job.folder.display()))
        })?;
    }
    // Tiles of one frame share the scene.
    let kept = Kept::default();
    let mut failures = vec![];
    for (index, unit) in units.iter().enumerate() {
        let name = job.name(*unit);
        if args.openjd {
            say!(
                "openjd_progress: {:.1}",
                100.0 * index as f64 / units.len() as f64
            );
            say!("openjd_status: rendering {name}");
        }
        match job.check_tile(&folder, *unit, Care::Whole) {
            Ok(()) => {
                say!("{name}: complete already");
                continue;
            }
            Err(Some(why)) => say!("{name} is rendered again: {why}"),
            Err(None) => {}
        }
        match render(&job, &folder, *unit, args.threads, &kept) {
            Ok(seconds) => say!("{name}: {seconds:.2} s"),
            Err(Failure::Interrupted) => return Err(Failure::Interrupted),
            Err(failure) => {
                let text = text(&failure);
                terminal::line(&format!("error: {name}: {text}"));
                failures.push(format!("{name}: {text}"));
            }
        }
    }
    if args.openjd {
        match failures.first() {
            None => say!("openjd_progress: 100.0"),
            Some(first) => say!("openjd_fail: {}", first.replace('\n', " ")),
        }
    }
    match failures.is_empty() {
        true => Ok(()),
        false => Err(Failure::Reported),
    }
}

/// The parts that the command line names.
fn units(args: &TaskArgs, job: &Job) -> Result<Vec<Unit>, Failure> {
    if let Some(number) = args.task {
        let units = job.of_task(number);
        return match units.is_empty() {
            false => Ok(units),
            true => Err(Failure::new(format!(
                "there is no task {number}: the job has {} tasks",
                job.tasks()
            ))),
        };
    }
    let wanted = |unit: &Unit| {
        let number = job.frames[unit.frame].number;
        let frame = match (args.frames, number) {
            (Some((first, last)), Some(number)) => (first..=last).contains(&number),
            (Some(_), None) => false,
            (None, _) => true,
        };
        frame && args.tile.is_none_or(|tile| tile == unit.tile + 1)
    };
    let units: Vec<Unit> = job.all().filter(wanted).collect();
    match units.is_empty() {
        false => Ok(units),
        true => Err(Failure::new("the job has no such frame or tile")),
    }
}

/// The words of `strahl render` for a part.
fn words(job: &Job, folder: &Path, unit: Unit, threads: usize) -> Vec<String> {
    let frame = &job.frames[unit.frame];
    let shown = |path: PathBuf| path.display().to_string();
    let mut words = vec!["strahl".to_owned(), "render".to_owned()];
    words.extend(job.words.iter().cloned());
    words.push(format!("--threads={threads}"));
    words.push(format!("--expect={}", frame.scene));
    words.push(format!("--job-id={}", job.id()));
    words.push("--quiet".to_owned());
    if let Some(place) = job.place(unit.tile) {
        words.push(format!("--tile={place}"));
    }
    if let Some(number) = frame.number {
        words.push(format!("--only-frame={number}"));
    }
    if let Some(now) = job.now {
        words.push(format!("--now={now}"));
    }
    if job.bundled {
        words.push(format!("--bundle={}", shown(folder.join("scene"))));
    }
    words.push(format!("--output={}", shown(job.tile_file(folder, unit))));
    words.push(shown(folder.join(&job.scene)));
    words
}

/// Renders a part; returns the seconds it took.
fn render(
    job: &Job,
    folder: &Path,
    unit: Unit,
    threads: usize,
    kept: &Kept,
) -> Result<f64, Failure> {
    let start = Instant::now();
    let cli = Cli::try_parse_from(words(job, folder, unit, threads)).map_err(Failure::new)?;
    let Command::Render(args) = &cli.command else {
        return Err(Failure::new("the job's manifest names another command"));
    };
    let file = State::file(job, folder, unit);
    let mut state = State {
        host: host(),
        seconds: None,
        error: None,
    };
    note(&state, &file);
    let beat = beat(state.clone(), file.clone());
    let rendered = commands::render::render_with(args, Reporter::new(true), kept);
    drop(beat.0);
    // The thread returns nothing.
    let _ = beat.1.join();
    let checked = rendered.and_then(|()| {
        job.check_tile(folder, unit, Care::Whole).map_err(|why| {
            Failure::new(why.unwrap_or_else(|| "the tile was written, but is not there".into()))
        })
    });
    let seconds = start.elapsed().as_secs_f64();
    match &checked {
        Ok(()) => state.seconds = Some(seconds),
        Err(failure) => state.error = Some(text(failure)),
    }
    note(&state, &file);
    checked.map(|()| seconds)
}

/// Writes the state of a part. That it can't be written, on a full disk, is no reason not to render.
fn note(state: &State, file: &Path) {
    if let Err(error) = state.write(file) {
        terminal::line(&format!("warning: {error}"));
    }
}

/// Writes the state again and again while the part is rendered, as a sign of life; ends when the sender is dropped.
fn beat(state: State, file: PathBuf) -> (mpsc::Sender<()>, JoinHandle<()>) {
    let (end, ended) = mpsc::channel::<()>();
    let thread = std::thread::spawn(move || {
        while ended.recv_timeout(State::BEAT) == Err(mpsc::RecvTimeoutError::Timeout) {
            note(&state, &file);
        }
    });
    (end, thread)
}

fn text(failure: &Failure) -> String {
    match failure {
        Failure::Message(text) => text.clone(),
        Failure::Strict(what) => format!("{what} (--strict)"),
        Failure::Reported => "the scene has errors; they are in the log of the task".to_owned(),
        Failure::Interrupted => "interrupted".to_owned(),
    }
}

/// The machine's name.
fn host() -> String {
    let named = std::env::var("SLURMD_NODENAME").ok();
    let name = named.or_else(sysinfo::System::host_name);
    name.unwrap_or_else(|| "this machine".to_owned())
}
