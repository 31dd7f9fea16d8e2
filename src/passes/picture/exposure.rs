//! The log-average luminance of a picture (Reinhard et al. 2002, eq. 1), for automatic exposure.

use std::sync::Arc;

use glam::IVec2;

use crate::gpu::{
    Context, Format, Image, ImageDesc, Load, Pipeline, Recorder, Result, Sampler, shaders,
};
use crate::gpu_struct;

use crate::passes::fullscreen;

gpu_struct! {
    /// Size of the tiling.
    pub struct Push: push of LOG_LUMINANCE_FRAG {
        tiles: IVec2,
    }
}

const TILES: [u32; 2] = [32, 18];

/// The two steps and their images.
pub struct Exposure {
    tiles_pipeline: Pipeline,
    average_pipeline: Pipeline,
    tiles: Image,
    average: Image,
}

impl Exposure {
    /// # Errors
    /// When the device refuses.
    pub fn new(context: &Arc<Context>) -> Result<Self> {
        let image =
            |name, size| Image::new(context, &ImageDesc::flat(name, Format::R32_SFLOAT, size));
        let tile = |name, fragment| fullscreen(context, name, fragment, Format::R32_SFLOAT, &[]);
        Ok(Self {
            tiles_pipeline: tile("log luminance", &shaders::LOG_LUMINANCE_FRAG)?,
            average_pipeline: tile("average luminance", &shaders::AVERAGE_LUMINANCE_FRAG)?,
            tiles: image("log luminance of tiles", TILES)?,
            average: image("average luminance", [1, 1])?,
        })
    }

    /// Computes the log-average luminance of a picture: one texel, kcd/m².
    pub fn record(&mut self, recorder: &mut Recorder, radiance: &Image) -> &Image {
        let tiles = IVec2::new(TILES[0] as i32, TILES[1] as i32);
        recorder
            .pass("log luminance", &self.tiles_pipeline)
            .sample("radiance", radiance, Sampler::Nearest)
            .push(&Push { tiles })
            .color(&self.tiles, Load::Discard)
            .draw();
        recorder
            .pass("average luminance", &self.average_pipeline)
            .sample("log_luminance", &self.tiles, Sampler::Nearest)
            .color(&self.average, Load::Discard)
            .draw();
        &self.average
    }

    /// The one texel, kcd/m².
    pub fn image(&self) -> &Image {
        &self.average
    }
}
