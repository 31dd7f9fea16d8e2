//! Pictures drawn part by part: the same light on every part.

use super::Frame;
use crate::gpu::{Image, Result};
use crate::passes::occlusion::ssao::Ssao;
use crate::passes::view::Window;

/// What a part has from the picture that it belongs to.
#[derive(Default)]
pub(super) struct Parts {
    /// Where the part is; without it the frame is the whole picture.
    pub window: Option<Window>,
    /// Ambient occlusion of the whole picture, sample by sample: surfaces beyond a part's edge occlude too, and no edge is
    /// seen.
    shared: Vec<Image>,
}

impl Parts {
    /// The shared occlusion of sample `index`, if there is any; with fewer images than samples they come again.
    pub fn occlusion(&self, index: Option<u32>) -> Option<&Image> {
        let count = self.shared.len().max(1);
        self.shared.get(index.unwrap_or(0) as usize % count)
    }
}

impl Frame {
    /// Draws this part of a picture from now on.
    pub fn look_through(&mut self, window: Window) {
        self.parts.window = Some(window);
    }

    /// The ambient occlusion of the sample drawn last, which the frame gives away. No frame may be in flight.
    ///
    /// # Errors
    /// When the device refuses.
    pub fn take_occlusion(&mut self) -> Result<Image> {
        let size = self.settings.size.to_array();
        let next = Ssao::new(&self.context, size, self.settings.ssao)?;
        Ok(std::mem::replace(&mut self.ssao, next).into_image())
    }

    /// Lights all that is drawn from now on by the ambient occlusion of the whole picture, sample by sample.
    pub fn share_occlusion(&mut self, of_samples: Vec<Image>) {
        self.parts.shared = of_samples;
    }
}
