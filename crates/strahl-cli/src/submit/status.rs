//! `strahl submit status`: how far a job is.

use super::merge::{OUTCOME, Outcome};
use super::{open, word};
use crate::args::submit::StatusArgs;
use crate::output::say;
use crate::report::Failure;
use serde::Serialize;
use std::path::Path;
use strahl_farm::{Care, Job, Progress, Unit, progress, time_of};

/// The most failed or missing parts that the table names.
const MOST_SHOWN: usize = 10;

/// The state of a job.
#[derive(Debug, Serialize)]
struct Status {
    scene: String,
    frames: usize,
    tiles: usize,
    done: usize,
    running: Vec<Part>,
    failed: Vec<Part>,
    missing: Vec<Part>,
    /// Seconds until all is done, as far as the parts so far tell.
    seconds_left: Option<f64>,
    /// Whether all pictures are made; absent if nobody has tried.
    merged: Option<bool>,
}

/// A part that is not done.
#[derive(Debug, Serialize)]
struct Part {
    name: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    host: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    why: Option<String>,
}

/// The states of all parts of a job.
pub(super) fn states(job: &Job, folder: &Path, care: Care) -> Vec<(Unit, Progress)> {
    let now = time_of(folder);
    let all = job.all();
    all.map(|unit| (unit, progress(job, folder, unit, now, care)))
        .collect()
}

/// Prints how far a job is.
pub(super) fn status(args: &StatusArgs) -> Result<(), Failure> {
    let (folder, job) = open(&args.job)?;
    let status = Status::of(&job, &folder);
    if args.json {
        let json = serde_json::to_string_pretty(&status).map_err(Failure::new)?;
        say!("{json}");
        return Ok(());
    }
    status.print(&folder);
    Ok(())
}

impl Status {
    fn of(job: &Job, folder: &Path) -> Self {
        let (mut done, mut seconds) = (0, vec![]);
        let (mut running, mut failed, mut missing) = (vec![], vec![], vec![]);
        for (unit, progress) in states(job, folder, Care::Header) {
            let part = |host, why| Part {
                name: job.name(unit),
                host,
                why,
            };
            match progress {
                Progress::Done(took) => {
                    done += 1;
                    seconds.extend(took);
                }
                Progress::Running(state) => running.push(part(Some(state.host), None)),
                Progress::Failed(why) => failed.push(part(None, Some(why))),
                Progress::Missing(why) => missing.push(part(None, why)),
            }
        }
        let left = running.len() + missing.len();
        let mean = seconds.iter().sum::<f64>() / seconds.len().max(1) as f64;
        let seconds_left = match (left, running.len(), seconds.len()) {
            (0, _, _) => Some(0.0),
            (_, 0, _) | (_, _, 0) => None,
            (left, at_once, _) => Some(mean * left as f64 / at_once as f64),
        };
        let outcome = std::fs::read(folder.join(OUTCOME)).ok();
        let outcome: Option<Outcome> =
            outcome.and_then(|bytes| serde_json::from_slice(&bytes).ok());
        Self {
            scene: job.scene.display().to_string(),
            frames: job.frames.len(),
            tiles: job.tiles.len(),
            done,
            running,
            failed,
            missing,
            seconds_left,
            merged: outcome.map(|outcome| outcome.complete),
        }
    }

    fn print(&self, folder: &Path) {
        let all = self.frames * self.tiles;
        say!("{:>8} of {all} parts done", self.done);
        let groups = [
            ("running", &self.running),
            ("failed", &self.failed),
            ("missing", &self.missing),
        ];
        for (word, parts) in groups {
            if parts.is_empty() {
                continue;
            }
            say!("{:>8} {word}", parts.len());
            for part in parts.iter().take(MOST_SHOWN) {
                let host = part
                    .host
                    .as_ref()
                    .map_or(String::new(), |host| format!(" on {host}"));
                let why = part
                    .why
                    .as_ref()
                    .map_or(String::new(), |why| format!(": {why}"));
                say!("           {}{host}{why}", part.name);
            }
            if parts.len() > MOST_SHOWN {
                say!("           and {} more", parts.len() - MOST_SHOWN);
            }
        }
        let waits = self.running.len() + self.missing.len() > 0;
        if let Some(left) = self.seconds_left.filter(|_| waits) {
            say!("about {} left", duration(left));
        }
        match (self.merged, self.done == all) {
            (Some(true), true) => say!("the pictures are made"),
            (_, true) => say!(
                "the pictures are not made yet: `strahl submit merge {}`",
                word(folder)
            ),
            _ => {}
        }
    }
}

pub(super) fn duration(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    match whole {
        0..=9 => format!("{seconds:.2} s"),
        10..=99 => format!("{whole} s"),
        100..=5999 => format!("{} min", whole.div_ceil(60)),
        _ => format!("{:.1} h", seconds / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_have_fitting_units() {
        assert_eq!(duration(0.0123), "0.01 s");
        assert_eq!(duration(12.4), "12 s");
        assert_eq!(duration(100.0), "2 min");
        assert_eq!(duration(9000.0), "2.5 h");
    }
}
