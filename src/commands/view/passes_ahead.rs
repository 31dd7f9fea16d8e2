//! Another thread makes the passes of changed options, and the window goes on with those it has.

use std::sync::Arc;

use super::background::{Background, Wake};
use crate::frame::{Change, Replacement};
use crate::gpu::{Context, Recorder, Result, Timing};
use crate::options::Options;

/// What the passes are of.
#[derive(Debug, Clone)]
pub(super) struct Wanted {
    pub(super) options: Options,
    pub(super) is_hdr: bool,
}

/// The passes, and the recorder for the next ones.
type Made = (Result<Replacement>, Option<Recorder>);

/// The passes of the newest options, while they are made. One change at a time: a slider that moves on meanwhile is followed from there,
/// so that what was in between is never made.
pub(super) struct PassesAhead {
    context: Arc<Context>,
    wake: Wake,
    recorder: Option<Recorder>,
    making: Option<(Wanted, Background<Made>)>,
}

impl PassesAhead {
    /// Makes passes with `recorder`, which is not recording.
    pub(super) fn new(wake: &Wake, recorder: Recorder) -> Self {
        Self {
            context: recorder.context().clone(),
            wake: wake.clone(),
            recorder: Some(recorder),
            making: None,
        }
    }

    /// Whether passes are being made.
    pub(super) fn is_making(&self) -> bool {
        self.making.is_some()
    }

    /// Starts making the passes of a change, if none are being made.
    pub(super) fn start(&mut self, change: Change, wanted: Wanted) {
        if self.making.is_some() {
            return;
        }
        let (recorder, context) = (self.recorder.take(), self.context.clone());
        let work = move || {
            let recorder = recorder.map_or_else(|| Recorder::new(&context, Timing::Off), Ok);
            match recorder {
                Ok(mut recorder) => (change.prepare(&mut recorder), Some(recorder)),
                Err(error) => (Err(error), None),
            }
        };
        self.making = Some((wanted, Background::start(&self.wake, work)));
    }

    /// The passes that were asked for, once, when they are made.
    pub(super) fn made(&mut self) -> Option<(Wanted, Result<Replacement>)> {
        let (wanted, mut work) = self.making.take()?;
        match work.result() {
            Some((made, recorder)) => {
                self.recorder = recorder;
                Some((wanted, made))
            }
            None => {
                self.making = Some((wanted, work));
                None
            }
        }
    }

    /// Gives up what is being made.
    pub(super) fn give_up(&mut self) {
        if let Some((_, work)) = self.making.take() {
            self.recorder = work.wait().and_then(|(_, recorder)| recorder);
        }
    }
}

impl Drop for PassesAhead {
    /// No thread uses the device any more.
    fn drop(&mut self) {
        self.give_up();
    }
}
