//! The daylight follows the options; another thread solves the tables of a new air meanwhile, and the window goes on.

use crate::commands::job::Job;
use crate::commands::light::{air, sun_position};
use crate::daylight::atmosphere::Atmosphere;
use crate::daylight::atmosphere::air::Air;
use crate::daylight::sky::SkyModel;
use crate::error::Result;
use crate::options::Options;

use super::background::{Background, Wake};

/// The options of the present daylight and of the one being prepared.
pub(super) struct LightAhead {
    lit: Options,
    /// Options whose air a thread is solving. A slider that moves on meanwhile is followed from there.
    solving: Option<(Options, Background<()>)>,
    wake: Wake,
}

impl LightAhead {
    /// `lit` are the options of the present daylight.
    pub(super) fn new(lit: &Options, wake: &Wake) -> Self {
        Self {
            lit: lit.clone(),
            solving: None,
            wake: wake.clone(),
        }
    }

    /// Whether a daylight is being prepared.
    pub(super) fn is_solving(&self) -> bool {
        self.solving.is_some()
    }

    /// Updates the daylight to the job's options, or prepares that. Returns whether it is another one now.
    ///
    /// # Errors
    /// See [`Job::relight`].
    pub(super) fn follow(&mut self, job: &mut Job) -> Result<bool> {
        let mut is_other = false;
        if let Some((options, mut work)) = self.solving.take() {
            if work.result().is_none() {
                self.solving = Some((options, work));
                return Ok(false);
            }
            self.relight(job, options)?;
            is_other = true;
        }
        if job.settings.light() == self.lit.light() {
            return Ok(is_other);
        }
        match unsolved_air(&job.settings) {
            None => self.relight(job, job.settings.clone()).map(|()| true),
            Some(air) => {
                // A moment that the ephemeris does not cover is refused now, not after the wait.
                sun_position(&job.settings)?;
                let solve = move || drop(Atmosphere::of(&air));
                let work = Background::start(&self.wake, solve);
                self.solving = Some((job.settings.clone(), work));
                Ok(is_other)
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
