//! Ctrl-C while samples are drawn: the first time it asks for what there is, the second time it ends the program.

use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// Exit code of what a shell's user interrupts.
const INTERRUPTED: i32 = 130;

/// Listens from now on. Where that cannot be, Ctrl-C ends the program as it did before.
pub(super) fn listen() {
    let listening = ctrlc::set_handler(|| {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(INTERRUPTED);
        }
    });
    drop(listening);
}

/// Whether the user has asked for what there is.
pub(super) fn is_asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
