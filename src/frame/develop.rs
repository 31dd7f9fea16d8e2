//! Another look at a picture that is drawn.

use super::Frame;
use crate::gpu::{Recorder, Result};
use crate::passes::picture::tone_map::{ToneMap, ToneSettings};

impl Frame {
    /// Maps the newest picture again, by other settings. `rec` must be recording, with no frame in flight.
    ///
    /// # Errors
    /// When the device refuses.
    pub fn develop(&mut self, rec: &mut Recorder, tone: ToneSettings) -> Result<()> {
        let mut tone_map = ToneMap::new(&self.context, self.settings.size.to_array(), tone)?;
        tone_map.record(rec, self.radiance(), self.exposure.image());
        self.tone_map = tone_map;
        self.settings.tone = tone;
        Ok(())
    }
}
