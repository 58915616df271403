use std::sync::atomic::{AtomicBool, Ordering};

static PRESSED: AtomicBool = AtomicBool::new(false);

/// Makes Ctrl-C end the render at the next tile instead of the program at once; a second Ctrl-C ends the program.
pub(crate) fn listen() {
    #[expect(clippy::exit, reason = "the second Ctrl-C must end the program now")]
    // Without a handler Ctrl-C just ends the program, and files are only ever renamed into place when complete.
    let _ = ctrlc::set_handler(|| {
        if PRESSED.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
}

/// Whether Ctrl-C was pressed.
pub(crate) fn pressed() -> bool {
    PRESSED.load(Ordering::Relaxed)
}
