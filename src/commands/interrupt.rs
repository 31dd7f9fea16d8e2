//! Ctrl-C while samples are drawn: the first press writes the image so far, the second ends the program.

use std::sync::atomic::{AtomicBool, Ordering};

static IS_INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Exit code after an interrupt, by shell convention.
const EXIT_INTERRUPTED: i32 = 130;

/// Installs the handler. If that fails, Ctrl-C ends the program at once.
pub(super) fn listen() {
    let listening = ctrlc::set_handler(|| {
        if IS_INTERRUPTED.swap(true, Ordering::Relaxed) {
            std::process::exit(EXIT_INTERRUPTED);
        }
    });
    drop(listening);
}

/// Whether the user pressed Ctrl-C.
pub(super) fn is_interrupted() -> bool {
    IS_INTERRUPTED.load(Ordering::Relaxed)
}
