//! Times of the startup steps up to the first frame.

use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Wall time of one step, milliseconds.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// Name of the step.
    pub name: String,
    /// Wall time, milliseconds.
    pub ms: f64,
}

/// Steps of opening a device, and pipelines created since then.
#[derive(Debug)]
pub(in crate::gpu) struct Startup {
    last: Instant,
    pub(in crate::gpu) steps: Vec<Step>,
    pipelines: Mutex<Vec<Step>>,
}

impl Startup {
    pub(in crate::gpu) fn new() -> Self {
        Self {
            last: Instant::now(),
            steps: Vec::new(),
            pipelines: Mutex::new(Vec::new()),
        }
    }

    /// Records the step that ends now.
    pub(in crate::gpu) fn done(&mut self, name: &str) {
        let now = Instant::now();
        self.steps.push(Step {
            name: name.to_owned(),
            ms: (now - self.last).as_secs_f64() * 1e3,
        });
        self.last = now;
    }

    /// Records a pipeline whose creation began at `start`.
    pub(in crate::gpu) fn pipeline(&self, name: &str, start: Instant) {
        let step = Step {
            name: name.to_owned(),
            ms: start.elapsed().as_secs_f64() * 1e3,
        };
        // The list stays valid if a push panics.
        let mut pipelines = self
            .pipelines
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        pipelines.push(step);
    }

    pub(in crate::gpu) fn pipelines(&self) -> Vec<Step> {
        let pipelines = self
            .pipelines
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        pipelines.clone()
    }
}
