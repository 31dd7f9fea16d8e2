//! The sky's irradiance as a cube map: E(n) in klx, refined over frames.
//!
//! The lecture's layered pass: a geometry shader emits one triangle to the six faces (`gl_Layer`), the fragment shader
//! integrates the sky cube over a cosine-weighted hemisphere around the texel's direction. Sums are kept in 32-bit
//! floats and alternate between two cubes: in half floats the mean would stall after a few hundred samples.

use std::sync::Arc;

use crate::daylight::sampling::{cosine_hemisphere, sobol};
use crate::gpu::{
    Buffer, BufferKind, Context, Depth, Format, Image, ImageDesc, Load, Pipeline, PipelineDesc,
    Recorder, Result, Sampler, shaders, upload_buffer,
};
use crate::gpu_struct;

gpu_struct! {
    /// Which samples this pass adds.
    pub struct Push {
        first: u32,
        count: u32,
    }
}

/// How directions are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sampling {
    /// The lecture's `rnd(t)`, another sequence in each texel.
    MonteCarlo,
    /// A low-discrepancy sequence, the same in all texels.
    #[default]
    Quasi,
}

/// What is wanted of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IrradianceSettings {
    /// Edge of a face, texels.
    pub edge: u32,
    /// How directions are drawn.
    pub sampling: Sampling,
    /// Samples wanted in all.
    pub samples: u32,
    /// Samples added by one pass.
    pub samples_per_pass: u32,
}

impl Default for IrradianceSettings {
    fn default() -> Self {
        Self {
            edge: 32,
            sampling: Sampling::Quasi,
            samples: 512,
            samples_per_pass: 128,
        }
    }
}

/// The pass, its running sums and the map.
pub struct Irradiance {
    settings: IrradianceSettings,
    pipeline: Pipeline,
    samples: Buffer,
    sums: [Image; 2],
    irradiance: Image,
    done: u32,
}

impl Irradiance {
    /// Makes the cubes and uploads the sequence; `recorder` must be recording.
    ///
    /// # Errors
    /// When the device refuses.
    pub fn new(recorder: &mut Recorder, settings: IrradianceSettings) -> Result<Self> {
        let context: Arc<Context> = recorder.context().clone();
        let edge = settings.edge;
        let sum = |name| ImageDesc::cube(name, Format::R32G32B32A32_SFLOAT, edge);
        let map = ImageDesc::cube("sky irradiance", Format::R16G16B16A16_SFLOAT, edge);
        let monte_carlo = settings.sampling == Sampling::MonteCarlo;
        let pipeline = Pipeline::new(
            &context,
            &PipelineDesc {
                name: "irradiance",
                stages: &[
                    &shaders::FULLSCREEN_VERT,
                    &shaders::CUBE_FACES_GEOM,
                    &shaders::IRRADIANCE_FRAG,
                ],
                vertex: &[],
                colors: &[Format::R32G32B32A32_SFLOAT, Format::R16G16B16A16_SFLOAT],
                depth: Depth::Off,
                constants: &[("MONTE_CARLO", monte_carlo.into())],
            },
        )?;
        Ok(Self {
            pipeline,
            samples: upload_samples(recorder, &settings)?,
            sums: [
                Image::new(&context, &sum("irradiance sum 0"))?,
                Image::new(&context, &sum("irradiance sum 1"))?,
            ],
            irradiance: Image::new(&context, &map)?,
            settings,
            done: 0,
        })
    }

    /// Adds the next samples if some are still wanted; starts anew when the sky is new.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        sky_radiance: &Image,
        new_sky: bool,
    ) -> &Image {
        if new_sky {
            self.done = 0;
        }
        if !self.is_complete() {
            self.refine(recorder, sky_radiance);
        }
        &self.irradiance
    }

    /// Whether all samples are in.
    pub fn is_complete(&self) -> bool {
        self.done >= self.settings.samples
    }

    /// Samples so far.
    pub fn samples_done(&self) -> u32 {
        self.done
    }

    /// The map, klx.
    pub fn image(&self) -> &Image {
        &self.irradiance
    }

    /// The 32-bit sums of π L (klx) with the number of samples in the fourth channel.
    pub fn sums(&self) -> &Image {
        &self.sums[0]
    }

    fn refine(&mut self, recorder: &mut Recorder, sky_radiance: &Image) {
        let left = self.settings.samples - self.done;
        let push = Push {
            first: self.done,
            count: left.min(self.settings.samples_per_pass),
        };
        // The newest sums are always number 0: it becomes what is read.
        self.sums.swap(0, 1);
        let [new, old] = &self.sums;
        recorder
            .pass("irradiance", &self.pipeline)
            .sample("sky_radiance", sky_radiance, Sampler::Linear)
            .sample("previous_sum", old, Sampler::Nearest)
            .storage("Samples", &self.samples)
            .push(&push)
            .color(new, Load::Discard)
            .color(&self.irradiance, Load::Discard)
            .draw();
        self.done += push.count;
    }
}

fn upload_samples(recorder: &mut Recorder, settings: &IrradianceSettings) -> Result<Buffer> {
    let count = match settings.sampling {
        Sampling::Quasi => settings.samples,
        // The shader draws its own; the binding must exist all the same.
        Sampling::MonteCarlo => 1,
    };
    let directions: Vec<[f32; 3]> = (0..count)
        .map(|i| cosine_hemisphere(sobol(i)).as_vec3().to_array())
        .collect();
    let bytes = bytemuck::cast_slice(&directions);
    upload_buffer(recorder, "irradiance samples", BufferKind::Storage, bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::{GpuStruct, check_layout};

    #[test]
    fn host_and_shader_agree() {
        let push = shaders::IRRADIANCE_FRAG.push.expect("push");
        assert_eq!(check_layout(Push::FIELDS, push), Ok(()));
    }
}
