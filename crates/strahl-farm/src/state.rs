//! What tasks leave in a job folder about the state of their parts.

use crate::job::{Care, Job, Unit};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};
use strahl::formats::image::write_bytes;

/// A task that has given no sign of life for so long is not running any more. Tasks give one every [`State::BEAT`].
pub const SILENCE: Duration = Duration::from_secs(60);

/// The last thing that was heard of a part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// The machine.
    pub host: String,
    /// Seconds it took, if it is done.
    pub seconds: Option<f64>,
    /// Why it failed.
    pub error: Option<String>,
}

/// The state of a part.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress {
    /// Its tile is there and complete; seconds it took, if they are known.
    Done(Option<f64>),
    /// A task works on it.
    Running(State),
    /// Its last task ended with an error.
    Failed(String),
    /// Nobody works on it, with the reason if there is one.
    Missing(Option<String>),
}

impl State {
    /// How often tasks that work touch their state.
    pub const BEAT: Duration = Duration::from_secs(10);

    /// The file of a part's state.
    pub fn file(job: &Job, folder: &Path, unit: Unit) -> PathBuf {
        folder
            .join("state")
            .join(format!("{}.json", job.name(unit)))
    }

    /// Writes the state. A disk without space is no reason not to render, so an error is only returned.
    ///
    /// # Errors
    /// It can't be written.
    pub fn write(&self, file: &Path) -> Result<(), String> {
        let json = serde_json::to_vec(self).map_err(|error| error.to_string())?;
        write_bytes(file, &json).map_err(|error| error.to_string())
    }
}

/// The state of a part. `now` is the time of the disk that the job folder is on.
pub fn progress(job: &Job, folder: &Path, unit: Unit, now: SystemTime, care: Care) -> Progress {
    let file = State::file(job, folder, unit);
    let state: Option<State> = fs::read(&file)
        .ok()
        .and_then(|bytes| serde_json::from_slice(&bytes).ok());
    let bad = match job.check_tile(folder, unit, care) {
        Ok(()) => return Progress::Done(state.and_then(|state| state.seconds)),
        Err(why) => why,
    };
    let Some(state) = state else {
        return Progress::Missing(bad);
    };
    if let Some(error) = state.error {
        return Progress::Failed(error);
    }
    let heard = fs::metadata(&file).and_then(|metadata| metadata.modified());
    let silent = heard.ok().and_then(|heard| now.duration_since(heard).ok());
    match (state.seconds, silent) {
        (None, None) => Progress::Running(state),
        (None, Some(silent)) if silent < SILENCE => Progress::Running(state),
        (None, Some(silent)) => Progress::Missing(Some(format!(
            "its task on {} has ended without a word, {} s ago or more",
            state.host,
            silent.as_secs()
        ))),
        (Some(_), _) => Progress::Missing(bad),
    }
}

/// The time of the disk that a folder is on, which may differ from that of this machine.
pub fn time_of(folder: &Path) -> SystemTime {
    let file = folder.join(format!(".now-{}", std::process::id()));
    let time = fs::write(&file, "").and_then(|()| fs::metadata(&file)?.modified());
    // If it stays behind it is written again next time.
    let _ = fs::remove_file(&file);
    time.unwrap_or_else(|_| SystemTime::now())
}
