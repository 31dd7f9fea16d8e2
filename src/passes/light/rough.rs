//! What all lobes of GGX of a scene share: the sky prefiltered for them.

use crate::daylight::microfacet::LEAST_ALPHA;
use crate::gpu::{Image, Recorder, Result};

use crate::passes::sky::cube::SkyImages;
use crate::passes::sky::specular::SpecularCube;

/// Samples of a texel of the prefiltered sky.
const SAMPLES: u32 = 64;

/// The prefiltered sky.
pub struct RoughSky {
    cube: SpecularCube,
}

impl RoughSky {
    /// Uploads the samples; `recorder` must be recording.
    ///
    /// # Errors
    /// Fails when the device is out of memory.
    pub fn new(recorder: &mut Recorder) -> Result<Self> {
        Ok(Self {
            cube: SpecularCube::new(recorder, SAMPLES, None)?,
        })
    }

    /// Prefilters the sky if it is new.
    pub fn record(&mut self, recorder: &mut Recorder, sky: &SkyImages<'_>) {
        self.cube.record(recorder, sky);
    }

    /// The prefiltered sky, kcd/m².
    pub fn prefiltered(&self) -> &Image {
        self.cube.image()
    }
}

/// Constants of pipelines with `include/microfacet.glsl`: whether there are lobes, and a factor on what they reflect.
pub(in crate::passes) fn constants(has_any: bool, scale: f32) -> [(&'static str, u32); 3] {
    [
        ("ROUGH", has_any.into()),
        ("LOBE_SCALE", scale.to_bits()),
        ("LEAST_ALPHA", (LEAST_ALPHA as f32).to_bits()),
    ]
}
