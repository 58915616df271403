//! Ctrl-C: the render ends between two tiles, and the program within a second whatever it is doing.
//!
//! The thread that hears Ctrl-C gives the others a moment to end by themselves. What is in the middle of something long (a
//! loop of the scene, the building of a tree, one slow pixel) is not asked: nobody needs to look at a flag there, and the program
//! ends all the same. Pictures are renamed into place when they are complete, so there is never half of one.

use crate::terminal;
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError, mpsc};
use std::time::Duration;

/// How long the others have.
const MOMENT: Duration = Duration::from_millis(600);

static PRESSED: AtomicBool = AtomicBool::new(false);
static ENDING: AtomicBool = AtomicBool::new(false);
static LOST: Mutex<String> = Mutex::new(String::new());

/// Makes Ctrl-C end the program with a word; a second Ctrl-C ends it at once.
pub(crate) fn listen() {
    // Without a handler Ctrl-C just ends the program.
    let _ = ctrlc::set_handler(|| {
        if PRESSED.swap(true, Ordering::Relaxed) {
            end(130);
        }
        // This thread hears no second Ctrl-C while it sleeps, but ends the program soon enough.
        std::thread::sleep(MOMENT);
        if ends() {
            // Whoever reads the standard error may be in no hurry.
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

/// Says what is lost and what is kept if Ctrl-C is pressed from now on.
pub(crate) fn would_lose(what: impl Into<String>) {
    *LOST.lock().unwrap_or_else(PoisonError::into_inner) = what.into();
}

/// What is lost and what is kept.
pub(crate) fn lost() -> String {
    LOST.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

/// Whether the caller is the one to end the program with a last word: only one thread is. A thread that comes later has nothing to
/// say any more.
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

/// Says that Ctrl-C ended the program.
pub(crate) fn say(what: &str) {
    terminal::line(&match what {
        "" => "interrupted".to_owned(),
        what => format!("interrupted; {what}"),
    });
}

/// A stream that fails once Ctrl-C was pressed, so that large files are given up soon.
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
