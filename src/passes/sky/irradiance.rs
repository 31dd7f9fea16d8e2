//! The sky's irradiance E(n) as a cube map in klx, computed by one of four methods.
//!
//! The two sampling methods follow the lecture's layered pass: a geometry shader emits one triangle to the six faces
//! (`gl_Layer`), and the fragment shader integrates the sky cube over a cosine-weighted hemisphere around the texel's
//! direction. Sums are 32-bit floats and alternate between two cubes; in half floats the mean would stall after a few hundred
//! samples.
//!
//! `exact` sums a coarse sky cube with exact texel solid angles. `sh` evaluates nine spherical harmonics coefficients that the
//! CPU computed. Both take one pass.

use std::sync::Arc;

use crate::daylight::cube::{texel_direction, texel_solid_angle, texels};
use crate::daylight::irradiance::{IrradianceMethod, SphericalHarmonics};
use crate::daylight::sample_count::filtered_samples;
use crate::daylight::sky::Daylight;
use crate::gpu::{
    Buffer, BufferKind, Context, Format, Image, ImageDesc, Recorder, Result, Sampler, shaders,
    upload_buffer,
};
use crate::gpu_struct;

use crate::passes::kilo;
use crate::passes::sky::cube::{COARSE_EDGE, SMOOTH_EDGE, SkyImages};
use crate::passes::sky::route::{CubePipeline, CubeRoute, CubeShaders};

gpu_struct! {
    /// The range of samples that this pass adds.
    pub struct Push: push of IRRADIANCE_FRAG, IRRADIANCE_COMP {
        first: u32,
        count: u32,
    }
}

gpu_struct! {
    /// Number of texels summed.
    pub struct ExactPush: push of IRRADIANCE_EXACT_FRAG, IRRADIANCE_EXACT_COMP {
        count: u32,
    }
}

gpu_struct! {
    /// Nine spherical harmonics coefficients of the radiance.
    pub struct ShPush: push of IRRADIANCE_SH_FRAG, IRRADIANCE_SH_COMP {
        coefficients: [[f32; 3]; 9],
    }
}

/// Settings of the irradiance map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IrradianceSettings {
    /// Edge of a face, texels.
    pub edge: u32,
    /// How E is computed.
    pub method: IrradianceMethod,
    /// Total number of samples, for the two sampling methods.
    pub samples: u32,
    /// Samples added per pass.
    pub samples_per_pass: u32,
    /// How the texels are written; `None`: chosen by what the device supports.
    pub route: Option<CubeRoute>,
}

impl Default for IrradianceSettings {
    fn default() -> Self {
        Self {
            edge: 32,
            method: IrradianceMethod::Quasi,
            samples: 1024,
            samples_per_pass: 256,
            route: None,
        }
    }
}

/// The irradiance pass, its running sums and the map.
pub struct Irradiance {
    settings: IrradianceSettings,
    pipeline: CubePipeline,
    /// Low-discrepancy directions, or the texels of the exact sum.
    table: Buffer,
    /// Directions of the draft.
    draft: Option<Buffer>,
    sums: [Image; 2],
    irradiance: Image,
    done: u32,
}

/// Samples of a draft: an rms error of 0.5 % of the largest irradiance, in a sixth of the time of a regular pass.
const DRAFT_SAMPLES: u32 = 64;

/// Of the sums and of the map: half floats are too coarse for 1e-6 klx of a night.
const COLORS: [Format; 2] = [Format::R32G32B32A32_SFLOAT; 2];

const SAMPLED: CubeShaders = CubeShaders {
    fragment: &shaders::IRRADIANCE_FRAG,
    compute: &shaders::IRRADIANCE_COMP,
};
const EXACT: CubeShaders = CubeShaders {
    fragment: &shaders::IRRADIANCE_EXACT_FRAG,
    compute: &shaders::IRRADIANCE_EXACT_COMP,
};
const SH: CubeShaders = CubeShaders {
    fragment: &shaders::IRRADIANCE_SH_FRAG,
    compute: &shaders::IRRADIANCE_SH_COMP,
};

fn pipeline(context: &Arc<Context>, settings: &IrradianceSettings) -> Result<CubePipeline> {
    let method = settings.method;
    let random = [(
        "MONTE_CARLO",
        u32::from(method == IrradianceMethod::MonteCarlo),
    )];
    let (shaders, constants): (_, &[(&str, u32)]) = match method {
        IrradianceMethod::MonteCarlo | IrradianceMethod::Quasi => (SAMPLED, &random),
        IrradianceMethod::Exact => (EXACT, &[]),
        IrradianceMethod::Sh => (SH, &[]),
    };
    let route = settings.route.unwrap_or_else(|| CubeRoute::of(context));
    CubePipeline::new(context, route, "irradiance", shaders, &COLORS, constants)
}

impl Irradiance {
    /// Creates the cubes and uploads the table. `recorder` must be recording.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(recorder: &mut Recorder, settings: IrradianceSettings) -> Result<Self> {
        let context: Arc<Context> = recorder.context().clone();
        let cube =
            |name, format| Image::new(&context, &ImageDesc::cube(name, format, settings.edge));
        Ok(Self {
            pipeline: pipeline(&context, &settings)?,
            table: upload_table(recorder, &settings)?,
            draft: upload_draft(recorder, &settings)?,
            sums: [
                cube("irradiance sum 0", COLORS[0])?,
                cube("irradiance sum 1", COLORS[0])?,
            ],
            irradiance: cube("sky irradiance", COLORS[1])?,
            settings,
            done: 0,
        })
    }

    /// Adds the next samples until the total is reached; restarts when the sky has changed. Since a moving sky changes every frame,
    /// the first frame is a draft: few samples, filtered accordingly and not kept.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        sky: &SkyImages<'_>,
        daylight: &Daylight,
    ) -> &Image {
        if sky.is_new {
            self.done = 0;
            if let Some(draft) = &self.draft {
                self.add(recorder, sky.smooth, draft, [0, DRAFT_SAMPLES]);
                return &self.irradiance;
            }
        }
        self.refine(recorder, sky, daylight);
        &self.irradiance
    }

    /// Like [`Irradiance::record`], without drafts: for a static sky.
    pub fn refine(&mut self, recorder: &mut Recorder, sky: &SkyImages<'_>, daylight: &Daylight) {
        if sky.is_new {
            self.done = 0;
        }
        if !self.is_complete() {
            match self.settings.method {
                IrradianceMethod::MonteCarlo => self.add_samples(recorder, sky.radiance),
                IrradianceMethod::Quasi => self.add_samples(recorder, sky.smooth),
                IrradianceMethod::Exact => self.sum_texels(recorder, sky.coarse),
                IrradianceMethod::Sh => self.evaluate_harmonics(recorder, daylight),
            }
        }
    }

    /// The settings.
    pub fn settings(&self) -> &IrradianceSettings {
        &self.settings
    }

    /// Whether all samples have been added.
    pub fn is_complete(&self) -> bool {
        let wanted = if self.settings.method.is_sampled() {
            self.settings.samples
        } else {
            1
        };
        self.done >= wanted
    }

    /// Samples so far; for the methods without samples, 1 when done.
    pub fn samples_done(&self) -> u32 {
        self.done
    }

    /// The map, klx.
    pub fn image(&self) -> &Image {
        &self.irradiance
    }

    /// The 32-bit sums (klx), with the number of samples in the fourth channel: E is the quotient.
    pub fn sums(&self) -> &Image {
        &self.sums[0]
    }

    /// The outputs, by their names in the shaders.
    fn cubes(&self) -> [(&'static str, &Image); 2] {
        [("sum", &self.sums[0]), ("sky_irradiance", &self.irradiance)]
    }

    fn add_samples(&mut self, recorder: &mut Recorder, sky_radiance: &Image) {
        let left = self.settings.samples - self.done;
        let count = left.min(self.settings.samples_per_pass);
        // The newest sums are always at index 0.
        self.sums.swap(0, 1);
        self.add(recorder, sky_radiance, &self.table, [self.done, count]);
        self.done += count;
    }

    /// Writes the sums so far plus a range (first, count) of the samples of a table.
    fn add(
        &self,
        recorder: &mut Recorder,
        sky_radiance: &Image,
        table: &Buffer,
        [first, count]: [u32; 2],
    ) {
        let pass = self
            .pipeline
            .pass(recorder, "irradiance")
            .sample("sky_radiance", sky_radiance, Sampler::Linear)
            .sample("previous_sum", &self.sums[1], Sampler::Nearest)
            .storage("Samples", table)
            .push(&Push { first, count });
        self.pipeline.fill(pass, &self.cubes());
    }

    fn sum_texels(&mut self, recorder: &mut Recorder, coarse_radiance: &Image) {
        let pass = self
            .pipeline
            .pass(recorder, "irradiance")
            .sample("coarse_radiance", coarse_radiance, Sampler::Nearest)
            .storage("Texels", &self.table)
            .push(&ExactPush {
                count: 6 * COARSE_EDGE * COARSE_EDGE,
            });
        self.pipeline.fill(pass, &self.cubes());
        self.done = 1;
    }

    fn evaluate_harmonics(&mut self, recorder: &mut Recorder, daylight: &Daylight) {
        let projected = SphericalHarmonics::project(|direction| daylight.radiance(direction));
        let coefficients = projected.radiance.map(|c| kilo(c).to_array());
        let pass = self.pipeline.pass(recorder, "irradiance");
        self.pipeline
            .fill(pass.push(&ShPush { coefficients }), &self.cubes());
        self.done = 1;
    }
}

/// Uploads the table that the shader reads per sample.
fn upload_table(recorder: &mut Recorder, settings: &IrradianceSettings) -> Result<Buffer> {
    let edge = COARSE_EDGE as usize;
    let numbers: Vec<f32> = match settings.method {
        IrradianceMethod::Quasi => sample_table(settings.samples),
        IrradianceMethod::Exact => texels(edge)
            .flat_map(|(face, i, j)| {
                let direction = texel_direction(face, i, j, edge);
                direction
                    .extend(texel_solid_angle(i, j, edge))
                    .as_vec4()
                    .to_array()
            })
            .collect(),
        // These two need no table, but the declared binding must be written.
        IrradianceMethod::MonteCarlo | IrradianceMethod::Sh => vec![0.0; 4],
    };
    let bytes = bytemuck::cast_slice(&numbers);
    upload_buffer(recorder, "irradiance table", BufferKind::Storage, bytes)
}

/// Uploads the samples of a draft, if one frame does not draw all samples.
fn upload_draft(recorder: &mut Recorder, settings: &IrradianceSettings) -> Result<Option<Buffer>> {
    let is_wanted =
        settings.method == IrradianceMethod::Quasi && settings.samples > settings.samples_per_pass;
    let samples = || bytemuck::cast_slice(&sample_table(DRAFT_SAMPLES)).to_vec();
    is_wanted
        .then(|| {
            upload_buffer(
                recorder,
                "irradiance draft",
                BufferKind::Storage,
                &samples(),
            )
        })
        .transpose()
}

/// Low-discrepancy directions, each with the mip level of its lookup.
fn sample_table(count: u32) -> Vec<f32> {
    filtered_samples(count)
        .into_iter()
        .flat_map(|s| {
            s.direction
                .extend(s.level(SMOOTH_EDGE))
                .as_vec4()
                .to_array()
        })
        .collect()
}
