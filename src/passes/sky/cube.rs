//! The sky as a cube map: radiance in kcd/m² on 6 faces, with the ground below the horizon and without the sun's disc.

use std::sync::Arc;

use glam::Vec3;

use crate::daylight::grey_sky::GreySky;
use crate::daylight::hosek::Hosek;
use crate::daylight::preetham::PerezSky;
use crate::daylight::sky::{Daylight, Sky};
use crate::gpu::{Context, Format, Image, ImageDesc, Recorder, Result, shaders};
use crate::gpu_struct;

use crate::passes::kilo;
use crate::passes::sky::route::{CubePipeline, CubeRoute, CubeShaders};

gpu_struct! {
    /// Parameters common to all sky models, see [`crate::daylight::sky`].
    pub struct Push: push of
        SKY_PREETHAM_FRAG, SKY_PREETHAM_COMP, SKY_HOSEK_FRAG, SKY_HOSEK_COMP, SKY_GREY_FRAG, SKY_GREY_COMP
    {
        sun_direction: Vec3,
        scale: f32,
        night: Vec3,
        ground: Vec3,
        clouds: f32,
    }
}

gpu_struct! {
    /// Perez coefficients of Y, x and y.
    pub struct PreethamModel: model of SKY_PREETHAM_FRAG, SKY_PREETHAM_COMP {
        luminance: [f32; 5],
        chromaticity_x: [f32; 5],
        chromaticity_y: [f32; 5],
        zenith_over_f: Vec3,
    }
}

gpu_struct! {
    /// Coefficients of R, G and B.
    pub struct HosekModel: model of SKY_HOSEK_FRAG, SKY_HOSEK_COMP {
        coefficients: [f32; 27],
        mean_radiance: Vec3,
    }
}

gpu_struct! {
    /// Coefficients of a grey sky and its level, kcd/m².
    pub struct GreyModel: model of SKY_GREY_FRAG, SKY_GREY_COMP {
        gradation: [f32; 3],
        indicatrix: [f32; 4],
        least_cosine: f32,
        level: f32,
    }
}

/// Edge of the coarse cube, texels; the exact irradiance sum runs over its texels.
pub const COARSE_EDGE: u32 = 32;

/// Edge of the smooth cube, texels; filtered irradiance samples look up its mip levels.
pub const SMOOTH_EDGE: u32 = 128;

/// The outputs of the pass.
#[derive(Clone, Copy)]
pub struct SkyImages<'s> {
    /// The sky for background and reflections, kcd/m², half floats.
    pub radiance: &'s Image,
    /// The same at [`SMOOTH_EDGE`] with mip levels, 32-bit floats: a device may truncate when it stores half floats, and five
    /// levels of truncation would darken the sky by 0.2 %.
    pub smooth: &'s Image,
    /// The same at [`COARSE_EDGE`], 32-bit floats.
    pub coarse: &'s Image,
    /// Whether the images were drawn in this frame.
    pub is_new: bool,
}

/// Pipelines of the sky models, for targets of one format.
struct Painter {
    preetham: CubePipeline,
    hosek: CubePipeline,
    grey: CubePipeline,
}

const PREETHAM: CubeShaders = CubeShaders {
    fragment: &shaders::SKY_PREETHAM_FRAG,
    compute: &shaders::SKY_PREETHAM_COMP,
};
const HOSEK: CubeShaders = CubeShaders {
    fragment: &shaders::SKY_HOSEK_FRAG,
    compute: &shaders::SKY_HOSEK_COMP,
};
const GREY: CubeShaders = CubeShaders {
    fragment: &shaders::SKY_GREY_FRAG,
    compute: &shaders::SKY_GREY_COMP,
};

impl Painter {
    fn new(context: &Arc<Context>, format: Format) -> Result<Self> {
        let route = CubeRoute::of(context);
        let pipeline =
            |name, shaders| CubePipeline::new(context, route, name, shaders, &[format], &[]);
        Ok(Self {
            preetham: pipeline("sky: Preetham", PREETHAM)?,
            hosek: pipeline("sky: Hosek", HOSEK)?,
            grey: pipeline("sky: grey", GREY)?,
        })
    }

    fn paint(&self, recorder: &mut Recorder, daylight: &Daylight, target: &Image) {
        let push = Push {
            sun_direction: daylight.guard.sun_direction.as_vec3(),
            scale: daylight.guard.scale as f32,
            night: kilo(daylight.guard.night),
            ground: kilo(daylight.ground_luminance),
            clouds: (daylight.guard.clouds * 1e-3) as f32,
        };
        let pipeline = match &daylight.sky {
            Sky::Preetham(_) => &self.preetham,
            Sky::Hosek(_) => &self.hosek,
            Sky::Grey(_) => &self.grey,
        };
        let pass = pipeline.pass(recorder, "sky cube");
        let pass = match &daylight.sky {
            Sky::Preetham(sky) => pass.uniform("model", &preetham_model(&sky.perez())),
            Sky::Hosek(sky) => pass.uniform("model", &hosek_model(sky)),
            Sky::Grey(sky) => pass.uniform("model", &grey_model(sky)),
        };
        pipeline.fill(pass.push(&push), &[("sky_radiance", target)]);
    }
}

/// The sky pass and its cubes.
pub struct SkyCube {
    half: Painter,
    float: Painter,
    radiance: Image,
    smooth: Image,
    coarse: Image,
    drawn: Option<Daylight>,
}

impl SkyCube {
    /// Creates a cube with faces of `edge` texels, and the cubes for the irradiance.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, edge: u32) -> Result<Self> {
        let (half, float) = (Format::R16G16B16A16_SFLOAT, Format::R32G32B32A32_SFLOAT);
        let smooth = ImageDesc::cube("sky radiance, smooth", float, SMOOTH_EDGE).mipmapped();
        let coarse = ImageDesc::cube("sky radiance, coarse", float, COARSE_EDGE);
        Ok(Self {
            half: Painter::new(context, half)?,
            float: Painter::new(context, float)?,
            radiance: Image::new(context, &ImageDesc::cube("sky radiance", half, edge))?,
            smooth: Image::new(context, &smooth)?,
            coarse: Image::new(context, &coarse)?,
            drawn: None,
        })
    }

    /// Draws the sky if the daylight has changed.
    pub fn record(&mut self, recorder: &mut Recorder, daylight: &Daylight) -> SkyImages<'_> {
        let is_new = self.drawn.as_ref() != Some(daylight);
        if is_new {
            self.half.paint(recorder, daylight, &self.radiance);
            self.float.paint(recorder, daylight, &self.smooth);
            recorder.mipmap("sky mips", &self.smooth);
            self.float.paint(recorder, daylight, &self.coarse);
            self.drawn = Some(daylight.clone());
        }
        SkyImages {
            radiance: &self.radiance,
            smooth: &self.smooth,
            coarse: &self.coarse,
            is_new,
        }
    }

    /// Invalidates the cubes, so that the next frame redraws them.
    pub fn invalidate(&mut self) {
        self.drawn = None;
    }

    /// The cube, kcd/m².
    pub fn image(&self) -> &Image {
        &self.radiance
    }
}

fn hosek_model(sky: &Hosek) -> HosekModel {
    HosekModel {
        coefficients: std::array::from_fn(|i| sky.coefficients[i / 9][i % 9] as f32),
        mean_radiance: kilo(sky.mean_radiance),
    }
}

fn grey_model(sky: &GreySky) -> GreyModel {
    let distribution = &sky.distribution;
    GreyModel {
        gradation: distribution.gradation.map(|v| v as f32),
        indicatrix: distribution.indicatrix.map(|v| v as f32),
        least_cosine: distribution.least_cosine as f32,
        level: (sky.level * 1e-3) as f32,
    }
}

fn preetham_model(perez: &PerezSky) -> PreethamModel {
    let [luminance, chromaticity_x, chromaticity_y] =
        perez.coefficients.map(|row| row.map(|c| c as f32));
    let [y_zenith, x, y] = perez.zenith_over_f;
    PreethamModel {
        luminance,
        chromaticity_x,
        chromaticity_y,
        zenith_over_f: Vec3::new((y_zenith * 1e-3) as f32, x as f32, y as f32),
    }
}
