//! Screen-space ambient occlusion: the fraction A of the sky that surfaces within a radius leave visible.

use std::sync::Arc;

use crate::gpu::{
    Context, Depth, Format, Image, ImageDesc, Load, Pipeline, Recorder, Result, Route, Sampler,
    shaders,
};
use crate::gpu_struct;

use crate::passes::surfaces::gbuffer::Surfaces;
use crate::passes::view::View;
use crate::passes::{Screen, fullscreen_at, screen};

gpu_struct! {
    /// Push constants of the blur.
    pub struct BlurPush: push of SSAO_BLUR_FRAG, SSAO_BLUR_COMP {
        near: f32,
    }
}

gpu_struct! {
    /// Radius and noise.
    pub struct Push: push of SSAO_FRAG, SSAO_COMP {
        radius: f32,
        phase: f32,
    }
}

/// Settings of the ambient occlusion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SsaoSettings {
    /// Radius, metres; 0 turns it off (A = 1).
    pub radius: f32,
    /// Pixels per occluder, along each axis; A is computed at every second occluder.
    pub downscale: u32,
    /// Samples on each side of the slice.
    pub steps: u32,
}

/// Occluders per point at which A is computed, along each axis.
const SPACING: u32 = 2;

impl SsaoSettings {
    /// Pixels per texel of A, along each axis.
    pub fn pixels_per_texel(&self) -> u32 {
        self.downscale * SPACING
    }
}

impl Default for SsaoSettings {
    fn default() -> Self {
        Self {
            radius: 5.0,
            downscale: 2,
            steps: 12,
        }
    }
}

/// The occlusion passes and their images.
pub struct Ssao {
    settings: SsaoSettings,
    /// For depth tests, on the route that has them.
    points: Option<Points>,
    trace: Pipeline,
    blur: Pipeline,
    noisy: Image,
    smooth: Image,
}

/// Depth at the points where A is computed; 0 is background.
struct Points {
    select: Pipeline,
    depth: Image,
}

impl Points {
    fn new(context: &Arc<Context>, points: [u32; 2], settings: SsaoSettings) -> Result<Self> {
        Ok(Self {
            select: fullscreen_at(
                context,
                "SSAO points",
                &shaders::SSAO_POINTS_FRAG,
                &[],
                Depth::Write(DEPTH),
                &[("PIXELS_PER_POINT", settings.pixels_per_texel())],
            )?,
            depth: Image::new(context, &ImageDesc::flat("points", DEPTH, points))?,
        })
    }

    fn record(&self, recorder: &mut Recorder, surfaces: &Surfaces) -> &Image {
        recorder
            .pass("SSAO points", &self.select)
            .sample("depth", &surfaces.depth, Sampler::Nearest)
            .depth(&self.depth, Load::Clear([0.0; 4]))
            .draw();
        &self.depth
    }
}

/// Two packed values per texel, see `include/occlusion.glsl`.
const FORMAT: Format = Format::R32_UINT;
const DEPTH: Format = Format::D32_SFLOAT;
/// A word of 0 is A = 1 at distance 0.
const OPEN: [f32; 4] = [0.0; 4];

impl Ssao {
    /// Creates the passes for pictures of `size` pixels.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, size: [u32; 2], settings: SsaoSettings) -> Result<Self> {
        let spacing = [("DOWNSCALE", settings.downscale), ("SPACING", SPACING)];
        let constants = [("STEPS", settings.steps), spacing[0], spacing[1]];
        let points = size.map(|edge| edge.div_ceil(settings.pixels_per_texel()));
        let route = context.route();
        let image = |name| {
            let desc = ImageDesc::flat(name, FORMAT, points);
            Image::new(context, &desc.target_by(route))
        };
        let on_points = |name, shaders, constants: &[_]| {
            let tests = Depth::Surface(DEPTH);
            screen(context, name, shaders, &[FORMAT], tests, constants)
        };
        let trace = Screen {
            fragment: &shaders::SSAO_FRAG,
            compute: &shaders::SSAO_COMP,
        };
        let blur = Screen {
            fragment: &shaders::SSAO_BLUR_FRAG,
            compute: &shaders::SSAO_BLUR_COMP,
        };
        Ok(Self {
            settings,
            points: (route == Route::Fragment)
                .then(|| Points::new(context, points, settings))
                .transpose()?,
            trace: on_points("SSAO", trace, &constants)?,
            blur: on_points("SSAO blur", blur, &spacing)?,
            noisy: image("occlusion, noisy")?,
            smooth: image("occlusion")?,
        })
    }

    /// The last computed A; consumes the passes.
    pub fn into_image(self) -> Image {
        self.smooth
    }

    /// Computes A of the surfaces in view. `phase` (0..1) varies the noise between frames.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        surfaces: &Surfaces,
        view: &View,
        phase: f32,
    ) -> &Image {
        if self.settings.radius <= 0.0 {
            // A = 1 everywhere; the distance is used by filters only.
            recorder.clear(&self.smooth, OPEN);
            return &self.smooth;
        }
        let points = self.points.as_ref();
        let selection = points.map_or(&surfaces.depth, |p| p.record(recorder, surfaces));
        recorder
            .pass("SSAO", &self.trace)
            .sample(
                "normal_material",
                &surfaces.normal_material,
                Sampler::Nearest,
            )
            .sample("depth", &surfaces.depth, Sampler::Nearest)
            .uniform("view", &view.block())
            .push(&Push {
                radius: self.settings.radius,
                phase,
            })
            .output("occlusion", &self.noisy, Load::Clear(OPEN))
            .selected_by(selection)
            .fill();
        recorder
            .pass("SSAO blur", &self.blur)
            .sample("noisy_occlusion", &self.noisy, Sampler::Nearest)
            .sample("depth", &surfaces.depth, Sampler::Nearest)
            .push(&BlurPush {
                near: view.camera.near,
            })
            .output("occlusion", &self.smooth, Load::Clear(OPEN))
            .selected_by(selection)
            .fill();
        &self.smooth
    }
}
