//! What the program is doing: progress shows it, and the error of a memory that is full names it.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

static WORK: Mutex<Option<(String, Instant)>> = Mutex::new(None);

fn work() -> MutexGuard<'static, Option<(String, Instant)>> {
    WORK.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Tells what is done from now on: `reading scene.pov`.
pub(crate) fn doing(what: impl Into<String>) {
    *work() = Some((what.into(), Instant::now()));
}

/// What is done now, and for how many seconds.
pub(crate) fn now() -> (String, f64) {
    match &*work() {
        Some((what, since)) => (what.clone(), since.elapsed().as_secs_f64()),
        None => ("starting".to_owned(), 0.0),
    }
}

/// What is done now, for a thread that must not wait.
pub(crate) fn at_once() -> Option<String> {
    let work = WORK.try_lock().ok()?;
    work.as_ref().map(|(what, _)| what.clone())
}
