//! The sessions of this process: one for each number of threads.

use crate::errors;
use pyo3::prelude::*;
use std::sync::{Mutex, PoisonError};
use strahl::{Session, Threads};

/// The sessions so far, with the process that started them and the number of threads asked for; 0 is one per processor.
static SESSIONS: Mutex<Vec<(u32, usize, Session)>> = Mutex::new(Vec::new());

/// The session with this many threads, at most one per processor; `None` is one per processor.
pub(crate) fn session(threads: Option<usize>) -> PyResult<Session> {
    let most = std::thread::available_parallelism().map_or(1, usize::from);
    let count = match threads {
        None => 0,
        Some(0) => return Err(errors::value("threads must be at least 1")),
        Some(count) if count >= most => 0,
        Some(count) => count,
    };
    let mut sessions = SESSIONS.lock().unwrap_or_else(PoisonError::into_inner);
    // After a fork there are no threads in the child. Its copies of their handles are of no use, and must not wait for them.
    let process = std::process::id();
    if sessions.iter().any(|(of, _, _)| *of != process) {
        std::mem::forget(std::mem::take(&mut *sessions));
    }
    if let Some((_, _, known)) = sessions.iter().find(|(_, number, _)| *number == count) {
        return Ok(known.clone());
    }
    let threads = match count {
        0 => Threads::All,
        count => Threads::Count(count),
    };
    let session = Session::new(threads).map_err(errors::value)?;
    sessions.push((process, count, session.clone()));
    Ok(session)
}

/// The number of threads that are used if none is asked for.
#[pyfunction]
pub(crate) fn thread_count() -> PyResult<usize> {
    Ok(session(None)?.threads())
}
