//! What all lobes of GGX of a scene share: their albedo ([`crate::daylight::microfacet`]), and the sky prefiltered for them.

use crate::daylight::microfacet::{LEAST_ALPHA, TABLE, table};
use crate::gpu::{Format, Image, ImageDesc, Pass, Recorder, Result, Sampler, upload_texture};

use crate::passes::sky::cube::SkyImages;
use crate::passes::sky::specular::SpecularCube;

/// Samples of a texel of the prefiltered sky.
const SAMPLES: u32 = 64;

/// The images.
pub struct RoughSky {
    albedo: Image,
    cube: SpecularCube,
}

impl RoughSky {
    /// Uploads the albedo; `recorder` must be recording.
    ///
    /// # Errors
    /// Fails when the device is out of memory.
    pub fn new(recorder: &mut Recorder) -> Result<Self> {
        let desc = ImageDesc::flat("albedo of lobes", Format::R32G32B32A32_SFLOAT, TABLE);
        let parts = table().into_iter();
        let texels: Vec<[f32; 4]> = parts.map(|[a, b]| [a, b, 0.0, 0.0]).collect();
        Ok(Self {
            albedo: upload_texture(recorder, &desc, &[bytemuck::cast_slice(&texels)])?,
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

    /// Samples the albedo in a pass with `include/microfacet.glsl`. Without lobes the pipeline reads none, but the binding must be
    /// written: `other` takes its place.
    pub fn sampled_by<'r>(this: Option<&'r Self>, pass: Pass<'r>, other: &'r Image) -> Pass<'r> {
        let albedo = this.map_or(other, |sky| &sky.albedo);
        pass.sample("lobe_albedo", albedo, Sampler::Linear)
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
