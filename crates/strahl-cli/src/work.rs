//! The current activity of the program, for progress and for the error of `--max-memory`.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

static WORK: Mutex<Option<(String, Instant)>> = Mutex::new(None);

fn work() -> MutexGuard<'static, Option<(String, Instant)>> {
    WORK.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Sets the current activity: `reading scene.pov`.
pub(crate) fn doing(what: impl Into<String>) {
    *work() = Some((what.into(), Instant::now()));
}

/// The current activity and its duration in seconds.
pub(crate) fn now() -> (String, f64) {
    match &*work() {
        Some((what, since)) => (what.clone(), since.elapsed().as_secs_f64()),
        None => ("starting".to_owned(), 0.0),
    }
}

/// The current activity, for a thread that must not wait for a lock.
pub(crate) fn at_once() -> Option<String> {
    let work = WORK.try_lock().ok()?;
    work.as_ref().map(|(what, _)| what.clone())
}
