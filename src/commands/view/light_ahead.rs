//! The daylight follows the options; another thread solves the tables of a new air meanwhile, and the window goes on.

use std::thread::{self, JoinHandle};

use crate::commands::job::Job;
use crate::commands::light::{air, sun_position};
use crate::daylight::atmosphere::Atmosphere;
use crate::daylight::atmosphere::air::Air;
use crate::daylight::sky::SkyModel;
use crate::error::Result;
use crate::options::Options;

/// The options of the present daylight and of the one being prepared.
pub(super) struct LightAhead {
    lit: Options,
    /// Options whose air a thread is solving. A slider that moves on meanwhile is followed from there.
    solving: Option<(Options, JoinHandle<()>)>,
}

impl LightAhead {
    /// `lit` are the options of the present daylight.
    pub(super) fn new(lit: &Options) -> Self {
        Self {
            lit: lit.clone(),
            solving: None,
        }
    }

    /// Whether a daylight is being prepared.
    pub(super) fn is_solving(&self) -> bool {
        self.solving.is_some()
    }

    /// Updates the daylight to the job's options, or prepares that.
    ///
    /// # Errors
    /// See [`Job::relight`].
    pub(super) fn follow(&mut self, job: &mut Job) -> Result<()> {
        if let Some((options, thread)) = self.solving.take() {
            if !thread.is_finished() {
                self.solving = Some((options, thread));
                return Ok(());
            }
            self.relight(job, options)?;
        }
        if job.settings.light() == self.lit.light() {
            return Ok(());
        }
        match unsolved_air(&job.settings) {
            None => self.relight(job, job.settings.clone()),
            Some(air) => {
                // A moment that the ephemeris does not cover is refused now, not after the wait.
                sun_position(&job.settings)?;
                let thread = thread::spawn(move || drop(Atmosphere::of(&air)));
                self.solving = Some((job.settings.clone(), thread));
                Ok(())
            }
        }
    }

    /// Goes back to the job's options, which it had followed before.
    ///
    /// # Errors
    /// See [`Job::relight`].
    pub(super) fn go_back(&mut self, job: &mut Job) -> Result<()> {
        self.solving = None;
        self.relight(job, job.settings.clone())
    }

    fn relight(&mut self, job: &mut Job, options: Options) -> Result<()> {
        job.relight(&options)?;
        self.lit = options;
        Ok(())
    }
}

/// The air that a daylight of the options would have to solve first, which takes the time of some ten frames.
fn unsolved_air(settings: &Options) -> Option<Air> {
    let air = air(settings);
    let is_needed = settings.sky == SkyModel::Atmosphere && !Atmosphere::is_solved(&air);
    is_needed.then_some(air)
}
