//! The hours of a weather file and the sensors of an open scene.

use super::super::interface::shift;
use super::super::keys::Shift;
use super::Document;
use crate::gpu::Recorder;

impl Document {
    /// Shifts the moment by a key: by the next hour of the weather file where its hours are shown.
    pub(super) fn shift(&mut self, Shift { hours, records }: Shift) {
        let settings = &mut self.job.settings;
        match self.year.as_mut().filter(|year| year.is_shown(settings)) {
            Some(year) => year.step(settings, records),
            None => shift(&mut settings.sun, hours * 3600.0),
        }
    }

    /// Advances the time of day by `seconds` of the sun's time.
    pub(in crate::commands::view) fn pass_time(&mut self, seconds: f64) {
        let settings = &mut self.job.settings;
        match self.year.as_mut().filter(|year| year.is_shown(settings)) {
            Some(year) => year.advance(settings, seconds),
            None => shift(&mut settings.sun, seconds),
        }
    }

    /// The record of the weather file whose hour is shown.
    pub(in crate::commands::view) fn record_shown(&self) -> Option<usize> {
        self.year.as_ref()?.shown(&self.job.settings)
    }

    /// Draws the cells of the sensors over the picture, if that or they have changed.
    pub(super) fn record_grid(&mut self, recorder: &mut Recorder, is_new: bool) {
        let record = self.record_shown();
        let desk = self.desk.as_ref().filter(|desk| desk.is_shown);
        let inputs = (&self.frame, self.drawn);
        let map = self.job.settings.colour_map;
        let drawn = self
            .overlay
            .record(recorder, desk, inputs, (record, map), is_new);
        if let Err(error) = drawn {
            self.fault = Some(error.to_string());
            if let Some(desk) = &mut self.desk {
                desk.is_shown = false;
            }
        }
    }

    /// Takes what other threads have found of the sensors, and lets them go on; whether there is something new.
    pub(in crate::commands::view) fn follow_desk(&mut self) -> bool {
        let record = self.record_shown();
        let Some(desk) = &mut self.desk else {
            return false;
        };
        let before = desk.revision();
        desk.follow(&self.job, record);
        desk.revision() != before
    }
}
