//! Cross-fade from the preview, shown during movement, to the converging picture at rest.
//!
//! The two differ because the preview only approximates the light of sky and bounces and, in the first frames, because of noise.
//! The last preview is kept and fades out along a smoothstep.

use std::sync::Arc;

use crate::gpu::{
    Context, Depth, Format, Image, ImageDesc, Load, Pipeline, Recorder, Result, Sampler, shaders,
};
use crate::gpu_struct;

use crate::passes::{Screen, screen};

/// Longest fade, frames.
const LONGEST: u32 = 64;

gpu_struct! {
    /// Weight of the preview.
    pub struct Push: push of FADE_FRAG, FADE_COMP {
        share: f32,
    }
}

/// The cross-fade pass and its image.
pub struct Fade {
    pipeline: Pipeline,
    image: Image,
    /// Frames of the average.
    frames: u32,
    has_preview: bool,
}

impl Fade {
    /// Creates the pass for pictures of `size` pixels, averaged over `samples` frames. In the last one the preview has weight 0.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, size: [u32; 2], samples: u32) -> Result<Self> {
        let format = Format::R32G32B32A32_SFLOAT;
        let shaders = Screen {
            fragment: &shaders::FADE_FRAG,
            compute: &shaders::FADE_COMP,
        };
        let desc = ImageDesc::flat("fading picture", format, size);
        Ok(Self {
            pipeline: screen(context, "fade", shaders, &[format], Depth::Off, &[])?,
            image: Image::new(context, &desc.target_by(context.route()))?,
            frames: samples,
            has_preview: false,
        })
    }

    /// Draws frame number `index` of an average. `is_previewed`: whether `preview` was shown before frame 0.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        preview: &Image,
        converging: &Image,
        index: u32,
        is_previewed: bool,
    ) -> &Image {
        if index == 0 {
            self.has_preview = is_previewed;
        }
        let share = if self.has_preview {
            share(index, self.frames)
        } else {
            0.0
        };
        recorder
            .pass("fade", &self.pipeline)
            .sample("preview", preview, Sampler::Nearest)
            .sample("converging", converging, Sampler::Nearest)
            .push(&Push { share })
            .output("radiance", &self.image, Load::Discard)
            .fill();
        &self.image
    }

    /// The newest picture.
    pub fn image(&self) -> &Image {
        &self.image
    }
}

/// Weight of the preview in frame number `index` of an average of `frames`: a smoothstep from 1 before the first frame to 0 in the last, or in
/// the 64th.
pub fn share(index: u32, frames: u32) -> f32 {
    let frames = frames.min(LONGEST);
    let t = ((index + 1) as f32 / frames.max(1) as f32).min(1.0);
    1.0 - t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_preview_fades_in_small_steps_and_is_gone_at_the_last_frame() {
        for frames in [1, 16, LONGEST] {
            let shares: Vec<f32> = (0..frames).map(|k| share(k, frames)).collect();
            let before = std::iter::once(1.0).chain(shares.iter().copied());
            let steps: Vec<f32> = before.zip(&shares).map(|(a, b)| a - b).collect();
            assert_eq!(shares.last(), Some(&0.0));
            assert!(
                steps
                    .iter()
                    .all(|s| *s >= 0.0 && *s <= 1.51 / frames as f32)
            );
        }
        assert_eq!(share(1000, LONGEST), 0.0);
    }
}
