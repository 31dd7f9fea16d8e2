//! The sky's irradiance as a cube map: E(n) in klx, by four methods.
//!
//! The lecture's layered pass: a geometry shader emits one triangle to the six faces (`gl_Layer`), the fragment shader
//! integrates the sky cube over a cosine-weighted hemisphere around the texel's direction. Sums are kept in 32-bit
//! floats and alternate between two cubes: in half floats the mean would stall after a few hundred samples.
//!
//! `exact` sums a coarse sky cube with exact texel solid angles instead, `sh` evaluates nine coefficients that the CPU
//! projected: both are done in one pass.

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
    /// Which samples this pass adds.
    pub struct Push: push of IRRADIANCE_FRAG, IRRADIANCE_COMP {
        first: u32,
        count: u32,
    }
}

gpu_struct! {
    /// How many texels are summed.
    pub struct ExactPush: push of IRRADIANCE_EXACT_FRAG, IRRADIANCE_EXACT_COMP {
        count: u32,
    }
}

gpu_struct! {
    /// Nine coefficients of the radiance.
    pub struct ShPush: push of IRRADIANCE_SH_FRAG, IRRADIANCE_SH_COMP {
        coefficients: [[f32; 3]; 9],
    }
}

/// Settings of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IrradianceSettings {
    /// Edge of a face, texels.
    pub edge: u32,
    /// How E is found.
    pub method: IrradianceMethod,
    /// Samples in all, of the two methods that sample.
    pub samples: u32,
    /// Samples added by one pass.
    pub samples_per_pass: u32,
    /// How the texels are written; None: as the device can.
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

/// The pass, its running sums and the map.
pub struct Irradiance {
    settings: IrradianceSettings,
    pipeline: CubePipeline,
    /// Directions of the low-discrepancy sequence, or the texels of the exact sum.
    table: Buffer,
    /// Those of the draft.
    draft: Option<Buffer>,
    sums: [Image; 2],
    irradiance: Image,
    done: u32,
}

/// Samples of a draft: 0.5 % rms of the largest irradiance, for a sixth of the time of the usual pass.
const DRAFT_SAMPLES: u32 = 64;

const COLORS: [Format; 2] = [Format::R32G32B32A32_SFLOAT, Format::R16G16B16A16_SFLOAT];

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
    /// Makes the cubes and uploads the table; `recorder` must be recording.
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

    /// Adds the next samples if some are still wanted; starts anew when the sky is new. Under a sky that moves that is every
    /// frame: the first is then a draft, whose few samples are filtered for their number and not kept.
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

    /// As [`Irradiance::record`], without drafts: for a sky that does not move.
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

    /// Whether all samples are in.
    pub fn is_complete(&self) -> bool {
        let wanted = if self.settings.method.is_sampled() {
            self.settings.samples
        } else {
            1
        };
        self.done >= wanted
    }

    /// Samples so far; 1 when a method that does not sample is done.
    pub fn samples_done(&self) -> u32 {
        self.done
    }

    /// The map, klx.
    pub fn image(&self) -> &Image {
        &self.irradiance
    }

    /// The 32-bit sums (klx) with the number of samples in the fourth channel: E is their quotient.
    pub fn sums(&self) -> &Image {
        &self.sums[0]
    }

    /// The outputs by their names in the shaders.
    fn cubes(&self) -> [(&'static str, &Image); 2] {
        [("sum", &self.sums[0]), ("sky_irradiance", &self.irradiance)]
    }

    fn add_samples(&mut self, recorder: &mut Recorder, sky_radiance: &Image) {
        let left = self.settings.samples - self.done;
        let count = left.min(self.settings.samples_per_pass);
        // The newest sums are always number 0: it becomes what is read.
        self.sums.swap(0, 1);
        self.add(recorder, sky_radiance, &self.table, [self.done, count]);
        self.done += count;
    }

    /// Draws the sums so far with so many samples more of a table, from the first on.
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

/// What the shader looks up, sample by sample.
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
        // These two need no table; a declared binding must be there all the same.
        IrradianceMethod::MonteCarlo | IrradianceMethod::Sh => vec![0.0; 4],
    };
    let bytes = bytemuck::cast_slice(&numbers);
    upload_buffer(recorder, "irradiance table", BufferKind::Storage, bytes)
}

/// The few samples of a draft, where fewer than all would be drawn in a frame.
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

/// The low-discrepancy directions, each with the mip level of its lookup.
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
