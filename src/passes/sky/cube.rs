//! The sky as a cube map: radiance in kcd/m² on 6 faces, with the ground below the horizon and without the sun's disc.

use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};

use crate::daylight::atmosphere::columns::horizon_cosine;
use crate::daylight::atmosphere::scattered_sky::ScatteredSky;
use crate::daylight::atmosphere::sky_view::toward;
use crate::daylight::grey_sky::GreySky;
use crate::daylight::hosek::Hosek;
use crate::daylight::preetham::PerezSky;
use crate::daylight::sky::{Daylight, Sky};
use crate::gpu::{Context, Format, Image, ImageDesc, Recorder, Result, Sampler, shaders};
use crate::gpu_struct;

use crate::passes::kilo;
use crate::passes::sky::atmosphere::{AtmosphereView, SkyViews};
use crate::passes::sky::mips::Mips;
use crate::passes::sky::route::{CubePipeline, CubeRoute, CubeShaders};

gpu_struct! {
    /// Parameters common to all sky models, see [`crate::daylight::sky`].
    pub struct Push: push of
        SKY_PREETHAM_FRAG, SKY_PREETHAM_COMP, SKY_HOSEK_FRAG, SKY_HOSEK_COMP, SKY_GREY_FRAG, SKY_GREY_COMP,
        SKY_ATMOSPHERE_FRAG, SKY_ATMOSPHERE_COMP
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

gpu_struct! {
    /// Where the tables of an atmosphere's view lie, and the light of its ground.
    pub struct ViewModel: model of SKY_ATMOSPHERE_FRAG, SKY_ATMOSPHERE_COMP {
        toward_sun: Vec2,
        toward_moon: Vec2,
        moon_share: f32,
        horizon: f32,
        ground_scale: f32,
    }
}

/// Edge of the coarse cube, texels; the exact irradiance sum runs over its texels.
pub const COARSE_EDGE: u32 = 32;

/// Edge of the smooth cube, texels; filtered irradiance samples look up its mip levels.
pub const SMOOTH_EDGE: u32 = 128;

/// The outputs of the pass.
#[derive(Clone, Copy)]
pub struct SkyImages<'s> {
    /// The sky for background and reflections, kcd/m², 32-bit floats: the night is as dark as the least steps of half floats.
    pub radiance: &'s Image,
    /// The same at [`SMOOTH_EDGE`] with mip levels.
    pub smooth: &'s Image,
    /// The same at [`COARSE_EDGE`].
    pub coarse: &'s Image,
    /// Whether the images were drawn in this frame.
    pub is_new: bool,
}

/// Pipelines of the sky models, for targets of one format.
struct Painter {
    preetham: CubePipeline,
    hosek: CubePipeline,
    grey: CubePipeline,
    atmosphere: CubePipeline,
    moonlit: CubePipeline,
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

const ATMOSPHERE: CubeShaders = CubeShaders {
    fragment: &shaders::SKY_ATMOSPHERE_FRAG,
    compute: &shaders::SKY_ATMOSPHERE_COMP,
};

impl Painter {
    fn new(context: &Arc<Context>, format: Format) -> Result<Self> {
        let route = CubeRoute::of(context);
        let pipeline = |name, shaders, constants: &[(&str, u32)]| {
            CubePipeline::new(context, route, name, shaders, &[format], constants)
        };
        Ok(Self {
            preetham: pipeline("sky: Preetham", PREETHAM, &[])?,
            hosek: pipeline("sky: Hosek", HOSEK, &[])?,
            grey: pipeline("sky: grey", GREY, &[])?,
            atmosphere: pipeline("sky: atmosphere", ATMOSPHERE, &[("MOON", 0)])?,
            moonlit: pipeline("sky: atmosphere, moon", ATMOSPHERE, &[("MOON", 1)])?,
        })
    }

    /// `views` are the tables of the view, if the sky is an atmosphere.
    fn paint(
        &self,
        recorder: &mut Recorder,
        daylight: &Daylight,
        views: Option<SkyViews<'_>>,
        target: &Image,
    ) {
        let mut push = push_of(daylight);
        let pipeline = match &daylight.sky {
            Sky::Preetham(_) => &self.preetham,
            Sky::Hosek(_) => &self.hosek,
            Sky::Grey(_) => &self.grey,
            Sky::Atmosphere(sky) if sky.moon.is_some() => &self.moonlit,
            Sky::Atmosphere(_) => &self.atmosphere,
        };
        let pass = pipeline.pass(recorder, "sky cube");
        let pass = match &daylight.sky {
            Sky::Preetham(sky) => pass.uniform("model", &preetham_model(&sky.perez())),
            Sky::Hosek(sky) => pass.uniform("model", &hosek_model(sky)),
            Sky::Grey(sky) => pass.uniform("model", &grey_model(sky)),
            Sky::Atmosphere(sky) => {
                let (ground_scale, added) = daylight.ground_of(sky);
                push.ground = kilo(added);
                let pass = pass.uniform("model", &view_model(sky, ground_scale));
                match views {
                    Some(SkyViews { sun, moon }) => pass
                        .sample("sky_view", sun, Sampler::Nearest)
                        .sample("moon_view", moon, Sampler::Nearest),
                    None => pass,
                }
            }
        };
        pipeline.fill(pass.push(&push), &[("sky_radiance", target)]);
    }
}

/// An atmosphere as the eye sees it from its own altitude.
pub(in crate::passes::sky) struct SkyBehind {
    pipeline: CubePipeline,
    radiance: Image,
}

impl SkyBehind {
    pub fn new(context: &Arc<Context>, edge: u32) -> Result<Self> {
        let float = Format::R32G32B32A32_SFLOAT;
        let (route, name) = (CubeRoute::of(context), "sky: behind");
        // The share of a moon that does not count is 0.
        let moonlit = [("MOON", 1)];
        let pipeline = CubePipeline::new(context, route, name, ATMOSPHERE, &[float], &moonlit)?;
        let radiance = Image::new(context, &ImageDesc::cube("sky behind", float, edge))?;
        Ok(Self { pipeline, radiance })
    }

    /// Draws the sky of the daylight from where `sky` is seen; `views` are the tables of its view.
    pub fn record(
        &self,
        recorder: &mut Recorder,
        daylight: &Daylight,
        sky: &ScatteredSky,
        views: SkyViews<'_>,
    ) {
        let (ground_scale, added) = daylight.ground_of(sky);
        let push = Push {
            ground: kilo(added),
            ..push_of(daylight)
        };
        let pass = self.pipeline.pass(recorder, "sky behind");
        let pass = pass
            .uniform("model", &view_model(sky, ground_scale))
            .sample("sky_view", views.sun, Sampler::Nearest)
            .sample("moon_view", views.moon, Sampler::Nearest);
        let target = [("sky_radiance", &self.radiance)];
        self.pipeline.fill(pass.push(&push), &target);
    }

    /// The cube, kcd/m².
    pub fn image(&self) -> &Image {
        &self.radiance
    }
}

fn push_of(daylight: &Daylight) -> Push {
    Push {
        sun_direction: daylight.guard.sun_direction.as_vec3(),
        scale: daylight.guard.scale as f32,
        night: kilo(daylight.guard.night),
        ground: kilo(daylight.ground_luminance),
        clouds: (daylight.guard.clouds * 1e-3) as f32,
    }
}

/// The sky pass and its cubes.
pub struct SkyCube {
    painter: Painter,
    radiance: Image,
    smooth: Image,
    mips: Mips,
    coarse: Image,
    atmosphere: AtmosphereView,
    drawn: Option<Daylight>,
}

impl SkyCube {
    /// Creates a cube with faces of `edge` texels, and the cubes for the irradiance.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, edge: u32) -> Result<Self> {
        let float = Format::R32G32B32A32_SFLOAT;
        let smooth = ImageDesc::cube("sky radiance, smooth", float, SMOOTH_EDGE).mipmapped();
        let coarse = ImageDesc::cube("sky radiance, coarse", float, COARSE_EDGE);
        Ok(Self {
            painter: Painter::new(context, float)?,
            radiance: Image::new(context, &ImageDesc::cube("sky radiance", float, edge))?,
            smooth: Image::new(context, &smooth)?,
            mips: Mips::new(context, float, SMOOTH_EDGE)?,
            coarse: Image::new(context, &coarse)?,
            atmosphere: AtmosphereView::new(context)?,
            drawn: None,
        })
    }

    /// Draws the sky if the daylight has changed.
    pub fn record(&mut self, recorder: &mut Recorder, daylight: &Daylight) -> SkyImages<'_> {
        let is_new = self.drawn.as_ref() != Some(daylight);
        if is_new {
            let views = match &daylight.sky {
                Sky::Atmosphere(sky) => Some(self.atmosphere.record(recorder, sky)),
                _ => None,
            };
            self.painter
                .paint(recorder, daylight, views, &self.radiance);
            self.painter.paint(recorder, daylight, views, &self.smooth);
            self.mips.record(recorder, &self.smooth);
            self.painter.paint(recorder, daylight, views, &self.coarse);
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
        self.atmosphere.invalidate();
        self.drawn = None;
    }

    /// The tables of an atmosphere's view under the sun and under the moon, kcd/m².
    pub fn sky_views(&self) -> &[Image; 2] {
        self.atmosphere.images()
    }

    /// The cube, kcd/m².
    pub fn image(&self) -> &Image {
        &self.radiance
    }
}

fn view_model(sky: &ScatteredSky, ground_scale: f64) -> ViewModel {
    let moon = sky.moon.as_ref();
    ViewModel {
        toward_sun: toward(sky.sun.direction).as_vec2(),
        toward_moon: toward(moon.map_or(DVec3::Y, |moon| moon.direction)).as_vec2(),
        moon_share: moon.map_or(0.0, |moon| moon.share) as f32,
        horizon: horizon_cosine(sky.atmosphere.observer()).asin() as f32,
        ground_scale: ground_scale as f32,
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
