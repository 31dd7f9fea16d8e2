//! Another look at a picture that is drawn.

use super::Frame;
use crate::gpu::{Recorder, Result};
use crate::passes::picture::tone_map::{ToneMap, ToneSettings};

impl Frame {
    /// Sets the share of the way, in log luminance, that an automatic exposure moves toward that of each following picture: 1 (the
    /// default) adapts at once, [`crate::daylight::exposure::adaptation`] smoothly.
    pub fn set_adaptation(&mut self, share: f64) {
        self.exposure.set_share(share as f32);
    }

    /// Exposes the newest picture again, which adapts the exposure further. `rec` must be recording.
    pub fn expose(&self, rec: &mut Recorder) {
        let radiance = self.radiance();
        let average = self.exposure.record(rec, radiance);
        self.tone_map.record(rec, radiance, average);
    }

    /// Maps the newest picture again, by other settings. `rec` must be recording, with no frame in flight.
    ///
    /// # Errors
    /// When the device refuses.
    pub fn develop(&mut self, rec: &mut Recorder, tone: ToneSettings) -> Result<()> {
        let tone_map = ToneMap::new(&self.context, self.settings.size.to_array(), tone)?;
        tone_map.record(rec, self.radiance(), self.exposure.image());
        self.tone_map = tone_map;
        self.settings.tone = tone;
        Ok(())
    }
}
