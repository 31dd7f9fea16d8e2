//! Where the time goes between the start and the first frame.

use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Time of one step, milliseconds of the wall clock.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// What was done.
    pub name: String,
    /// How long it took.
    pub ms: f64,
}

/// Steps of opening a device, and the pipelines made since.
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

    /// Notes what took the time since the last note.
    pub(in crate::gpu) fn done(&mut self, name: &str) {
        let now = Instant::now();
        self.steps.push(Step {
            name: name.to_owned(),
            ms: (now - self.last).as_secs_f64() * 1e3,
        });
        self.last = now;
    }

    /// Notes a pipeline that was begun at `start`.
    pub(in crate::gpu) fn pipeline(&self, name: &str, start: Instant) {
        let step = Step {
            name: name.to_owned(),
            ms: start.elapsed().as_secs_f64() * 1e3,
        };
        // A panic while pushing leaves a whole list behind.
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
