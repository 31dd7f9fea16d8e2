//! How an open scene follows its options: other threads prepare what takes long, and until then the window goes on with what it has.

use super::super::passes_ahead::Wanted;
use super::{Document, frame_settings};
use crate::commands::sun_series::SunSeries;
use crate::error::Result;
use crate::frame::Change;
#[cfg(feature = "hot-reload")]
use crate::frame::Frame;
#[cfg(feature = "hot-reload")]
use crate::gpu::Recorder;

impl Document {
    /// Whether daylight or frame are those of earlier options.
    pub(in crate::commands::view) fn is_behind(&self) -> bool {
        self.job.settings != self.followed
            || self.screen.is_hdr != self.is_hdr
            || self.light.is_solving()
            || self.passes.is_making()
            || self.surfaces.is_behind(&self.job.settings)
    }

    /// Updates daylight and frame to the options, as far as other threads have prepared that, and lets them prepare the rest: a new air,
    /// and passes. Until then those before stay, and the event loop is woken for the next update.
    ///
    /// # Errors
    /// Options that cannot be applied; the previous ones are restored.
    pub(in crate::commands::view) fn follow(&mut self) -> Result<()> {
        let followed = self.try_follow();
        if followed.is_err() {
            self.job.settings = self.followed.clone();
            // Both succeed: they did before, with the same options.
            self.job.suns = SunSeries::of(&self.job.settings, None)?;
            self.light.go_back(&mut self.job)?;
            self.start_over();
        }
        followed
    }

    fn try_follow(&mut self) -> Result<()> {
        self.job.suns = SunSeries::of(&self.job.settings, self.job.suns.take())?;
        if self.light.follow(&mut self.job)? {
            self.start_over();
        }
        if let Some((wanted, made)) = self.passes.made() {
            let mut passes = made?;
            // Changes that were taken back need no passes.
            if !self.change().1.is_none() {
                self.frame.swap(&mut passes);
                self.replaced.push(Box::new(passes));
                self.followed_to(wanted);
            }
        }
        if self.passes.is_making() {
            return Ok(());
        }
        self.follow_surfaces()?;
        let (wanted, change) = self.change();
        if !change.is_none() {
            self.passes.start(change, wanted);
        } else if wanted.options != self.followed || wanted.is_hdr != self.is_hdr {
            self.followed_to(wanted);
        }
        Ok(())
    }

    /// Takes the scene with changed materials, if another thread has made it, or lets it do so.
    fn follow_surfaces(&mut self) -> Result<()> {
        let settings = *self.frame.settings();
        let made = self
            .surfaces
            .follow(&self.job.scene, &self.job.settings, settings);
        if made.is_err() {
            self.surfaces.take_back(&mut self.followed);
        }
        if let Some((scene, frame)) = made? {
            self.replaced
                .push(Box::new(std::mem::replace(&mut self.frame, frame)));
            self.job.scene = scene;
            self.start_over();
        }
        Ok(())
    }

    /// What is wanted now, and the change to it.
    fn change(&self) -> (Wanted, Change) {
        let wanted = Wanted {
            options: self.job.settings.clone(),
            is_hdr: self.screen.is_hdr,
        };
        let settings = frame_settings(&self.job, wanted.is_hdr);
        (wanted, self.frame.change(settings))
    }

    /// Notes that the frame has the passes of these options, and shows them.
    fn followed_to(&mut self, wanted: Wanted) {
        if wanted.options.show != self.followed.show {
            self.adaptation.cut();
        }
        (self.followed, self.is_hdr) = (wanted.options, wanted.is_hdr);
        self.start_over();
    }

    /// Rebuilds the frame after its shaders changed. `recorder` must be recording.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources; the previous frame is kept.
    #[cfg(feature = "hot-reload")]
    pub(in crate::commands::view) fn rebuild(&mut self, recorder: &mut Recorder) -> Result<()> {
        // They may be of the old shaders.
        self.passes.give_up();
        let wanted = Wanted {
            options: self.job.settings.clone(),
            is_hdr: self.screen.is_hdr,
        };
        let settings = frame_settings(&self.job, wanted.is_hdr);
        self.frame = Frame::new(recorder, &self.job.scene, settings)?;
        self.followed_to(wanted);
        Ok(())
    }
}
