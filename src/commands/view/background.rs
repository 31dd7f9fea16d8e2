//! Work of other threads, which wake the event loop when it is done.

use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::thread::{self, JoinHandle};

/// Wakes the event loop; may be called by any thread.
pub(super) type Wake = Arc<dyn Fn() + Send + Sync>;

/// Work of another thread, and its result.
pub(super) struct Background<T> {
    thread: Option<JoinHandle<()>>,
    results: Receiver<T>,
}

/// Wakes the event loop when a thread ends, also by a panic.
struct AtEnd(Wake);

impl Drop for AtEnd {
    fn drop(&mut self) {
        (self.0)();
    }
}

impl<T: Send + 'static> Background<T> {
    /// Starts the work. Dropping it lets it go on to its end, whose result nobody gets.
    pub(super) fn start(wake: &Wake, work: impl FnOnce() -> T + Send + 'static) -> Self {
        let ((sender, results), wake) = (channel(), wake.clone());
        let thread = thread::spawn(move || {
            // Dropped last: who is woken finds the result, or that there is none.
            let _at_end = AtEnd(wake);
            let sender = sender;
            // Fails only if nobody waits for it any more.
            let _ = sender.send(work());
        });
        Self {
            thread: Some(thread),
            results,
        }
    }

    /// The result, once, when there is one. Propagates a panic of the thread.
    pub(super) fn result(&mut self) -> Option<T> {
        match self.results.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => {
                self.join();
                None
            }
        }
    }

    /// Waits for the end of the thread and returns the result, unless it was fetched already.
    pub(super) fn wait(mut self) -> Option<T> {
        self.join();
        self.results.try_recv().ok()
    }

    fn join(&mut self) {
        if let Some(thread) = self.thread.take() {
            thread.join().unwrap_or_else(|panic| resume_unwind(panic));
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::{Sender, channel};

    use super::*;

    fn waking() -> (Wake, Receiver<()>) {
        let (sender, woken) = channel();
        let wake = move || {
            let _: Result<(), _> = Sender::send(&sender, ());
        };
        (Arc::new(wake), woken)
    }

    #[test]
    fn the_result_is_there_when_the_loop_is_woken_and_comes_once() {
        let (wake, woken) = waking();
        let (go, may_go) = channel::<()>();
        let mut work = Background::start(&wake, move || {
            may_go.recv().expect("a go");
            7
        });
        assert_eq!(work.result(), None);
        go.send(()).expect("it waits");
        woken.recv().expect("woken");
        assert_eq!((work.result(), work.result()), (Some(7), None));
        let late = Background::start(&wake, || 8);
        assert_eq!(late.wait(), Some(8));
    }

    #[test]
    fn a_panic_wakes_too_and_goes_on_here() {
        let (wake, woken) = waking();
        let mut work = Background::<()>::start(&wake, || resume_unwind(Box::new("broken")));
        woken.recv().expect("woken");
        let found = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| work.result()));
        assert!(found.is_err());
    }
}
