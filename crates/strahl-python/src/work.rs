//! Long computations: without Python's lock, and stopped by Ctrl-C.

use crate::errors;
use pyo3::prelude::*;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::time::Duration;

/// How often Python gets to see signals and progress.
const TICK: Duration = Duration::from_millis(50);

/// Whether the caller has given up waiting for a computation.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Whether to stop.
    pub(crate) fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// The flag itself.
    pub(crate) fn flag(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.0)
    }
}

/// Runs a computation on a thread of its own, without Python's lock. See [`run_with`].
pub(crate) fn run<T: Send + 'static>(
    py: Python<'_>,
    compute: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    run_with(py, |_| compute(), |_| Ok(()))
}

/// Runs a computation on a thread of its own, without Python's lock. Meanwhile this thread looks for signals and calls `tick`, twenty times
/// a second.
///
/// An exception from a signal or from `tick` is returned at once: `Stop` tells the computation, which ends by itself some time later,
/// and its result is dropped. A panic becomes an exception.
pub(crate) fn run_with<T: Send + 'static>(
    py: Python<'_>,
    compute: impl FnOnce(&Stop) -> T + Send + 'static,
    tick: impl FnMut(Python<'_>) -> PyResult<()>,
) -> PyResult<T> {
    let stop = Stop::default();
    let (sender, receiver) = mpsc::sync_channel(1);
    let inner = stop.clone();
    std::thread::Builder::new()
        .name("strahl request".to_owned())
        .spawn(move || {
            // Without a receiver the caller has been interrupted.
            let _ = sender.send(caught(|| compute(&inner)));
        })?;
    wait(py, receiver, &stop, tick)
}

/// The same for a computation that borrows from the caller, and ends soon after a stop: an interrupted caller waits for that.
pub(crate) fn run_borrowed<T: Send>(
    py: Python<'_>,
    compute: impl FnOnce(&Stop) -> T + Send,
) -> PyResult<T> {
    let stop = Stop::default();
    let (sender, receiver) = mpsc::sync_channel(1);
    let inner = &stop;
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new()
            .name("strahl request".to_owned())
            .spawn_scoped(scope, move || {
                let _ = sender.send(caught(|| compute(inner)));
            })?;
        let result = wait(py, receiver, inner, |_| Ok(()));
        // Without Python's lock: other threads of Python run meanwhile. Panics are caught on the thread.
        let _ = py.detach(|| thread.join());
        result
    })
}

/// The same on this thread, for a computation that is over before anybody would want to stop it.
pub(crate) fn run_at_once<T: Send>(
    py: Python<'_>,
    compute: impl FnOnce(&Stop) -> T + Send,
) -> PyResult<T> {
    py.detach(|| caught(|| compute(&Stop::default())))
        .map_err(|payload| errors::of_panic(py, &*payload))
}

/// A result or a panic.
type Caught<T> = Result<T, Box<dyn Any + Send>>;

fn caught<T>(compute: impl FnOnce() -> T) -> Caught<T> {
    catch_unwind(AssertUnwindSafe(compute))
}

/// Waits for the result of another thread. Meanwhile looks for signals and calls `tick`.
fn wait<T: Send>(
    py: Python<'_>,
    mut receiver: Receiver<Caught<T>>,
    stop: &Stop,
    mut tick: impl FnMut(Python<'_>) -> PyResult<()>,
) -> PyResult<T> {
    loop {
        let (back, message) = py.detach(move || {
            let message = receiver.recv_timeout(TICK);
            (receiver, message)
        });
        receiver = back;
        match message {
            Ok(Ok(value)) => return Ok(value),
            Ok(Err(payload)) => return Err(errors::of_panic(py, &*payload)),
            Err(RecvTimeoutError::Disconnected) => {
                return Err(errors::internal(py, "a thread ended without a result"));
            }
            Err(RecvTimeoutError::Timeout) => {
                if let Err(error) = py.check_signals().and_then(|()| tick(py)) {
                    stop.0.store(true, Ordering::Relaxed);
                    return Err(error);
                }
            }
        }
    }
}

/// Panics as a bug in strahl would: tests look at what Python gets to see.
#[pyfunction]
pub(crate) fn panic_for_tests(py: Python<'_>) -> PyResult<()> {
    run(py, || panic!("asked for by a test"))
}
