//! Times of the steps from the start to the first frame.

use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Time of one step, milliseconds of the wall clock.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// What the step does.
    pub name: String,
    /// Its time.
    pub ms: f64,
}

/// Steps of opening a device, and the pipelines created since.
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

    /// Adds the step that ends now.
    pub(in crate::gpu) fn done(&mut self, name: &str) {
        let now = Instant::now();
        self.steps.push(Step {
            name: name.to_owned(),
            ms: (now - self.last).as_secs_f64() * 1e3,
        });
        self.last = now;
    }

    /// Adds a pipeline whose creation began at `start`.
    pub(in crate::gpu) fn pipeline(&self, name: &str, start: Instant) {
        let step = Step {
            name: name.to_owned(),
            ms: start.elapsed().as_secs_f64() * 1e3,
        };
        // A panic while pushing leaves a usable list.
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
