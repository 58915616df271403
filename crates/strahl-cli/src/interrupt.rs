//! Ctrl-C ends a render between two tiles, and the program within a second whatever it is doing.
//!
//! The thread that handles Ctrl-C gives the other threads a moment to end by themselves, then it ends the program. So long
//! computations (a loop in a scene, the building of a tree, a slow pixel) need not check a flag. Pictures are renamed into place
//! when they are complete, so an interrupted one leaves no partial file.

use crate::terminal;
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError, mpsc};
use std::time::Duration;

/// The time that the other threads have to end.
const MOMENT: Duration = Duration::from_millis(600);

static PRESSED: AtomicBool = AtomicBool::new(false);
static ENDING: AtomicBool = AtomicBool::new(false);
static LOST: Mutex<String> = Mutex::new(String::new());

/// Installs the handler: Ctrl-C ends the program with a message; a second Ctrl-C ends it at once.
pub(crate) fn listen() {
    // If the handler can't be installed, Ctrl-C ends the program without a message.
    let _ = ctrlc::set_handler(|| {
        if PRESSED.swap(true, Ordering::Relaxed) {
            end(130);
        }
        // A second Ctrl-C is not noticed while this thread sleeps, but the sleep is short.
        std::thread::sleep(MOMENT);
        if ends() {
            // Writing to the standard error may block, so another thread does it.
            let (said, heard) = mpsc::channel();
            std::thread::spawn(move || {
                say(&lost());
                said.send(())
            });
            let _ = heard.recv_timeout(MOMENT / 4);
            end(130);
        }
    });
}

/// Whether Ctrl-C was pressed.
pub(crate) fn pressed() -> bool {
    PRESSED.load(Ordering::Relaxed)
}

/// Sets the message about lost and kept results that Ctrl-C prints from now on.
pub(crate) fn would_lose(what: impl Into<String>) {
    *LOST.lock().unwrap_or_else(PoisonError::into_inner) = what.into();
}

/// The message about lost and kept results.
pub(crate) fn lost() -> String {
    LOST.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

/// Whether the caller must end the program with its last message: true for one thread only. Threads that come later must not
/// print any more.
pub(crate) fn ends() -> bool {
    !ENDING.swap(true, Ordering::Relaxed)
}

/// Waits for another thread to end the program.
pub(crate) fn wait() -> ! {
    loop {
        std::thread::park();
    }
}

/// Ends the program now.
#[expect(
    clippy::exit,
    reason = "the other threads are in the middle of something"
)]
pub(crate) fn end(code: i32) -> ! {
    std::process::exit(code)
}

/// Prints that Ctrl-C ended the program.
pub(crate) fn say(what: &str) {
    terminal::line(&match what {
        "" => "interrupted".to_owned(),
        what => format!("interrupted; {what}"),
    });
}

/// A stream that fails after Ctrl-C, so that writing a large file ends soon.
pub(crate) struct Interruptible<'a>(pub(crate) &'a mut dyn Write);

impl Write for Interruptible<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if pressed() {
            return Err(io::Error::other("interrupted"));
        }
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}
