//! The background: the sky cube along each pixel's ray where no surface is, and the sun's disc.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use crate::daylight::sunlight::SUN_ANGULAR_RADIUS;
use crate::gpu::{
    Context, Depth, Format, Image, Load, Pipeline, PipelineDesc, Recorder, Result, Sampler, shaders,
};
use crate::gpu_struct;

use super::kilo;
use super::lighting::{Light, LightingSettings, Show};
use super::view::View;

gpu_struct! {
    /// The sun's disc.
    pub struct Push {
        size: Vec2,
        direction: Vec3,
        luminance: Vec3,
        sin_radius: f32,
        limb: f32,
        max_radiance: f32,
    }
}

/// The pass; it completes the picture of [`super::lighting::Lighting`].
pub struct Background {
    settings: LightingSettings,
    pipeline: Pipeline,
}

/// Whether the sky is drawn, and otherwise what stands for "nothing".
fn content(show: Show) -> (bool, f32) {
    match show {
        Show::Beauty | Show::Luminance | Show::Background => (true, 0.0),
        // Nothing hides the sun or the sky from the sky.
        Show::Visibility | Show::Occlusion => (false, 1.0),
        _ => (false, 0.0),
    }
}

impl Background {
    /// # Errors
    /// When the device refuses.
    pub fn new(context: &Arc<Context>, settings: LightingSettings) -> Result<Self> {
        let (sky, empty) = content(settings.show);
        let pipeline = Pipeline::new(
            context,
            &PipelineDesc {
                name: "background",
                stages: &[&shaders::FULLSCREEN_VERT, &shaders::BACKGROUND_FRAG],
                vertex: &[],
                colors: &[settings.precision.format()],
                depth: Depth::Background(Format::D32_SFLOAT),
                constants: &[("SKY", sky.into()), ("EMPTY", empty.to_bits())],
            },
        )?;
        Ok(Self { settings, pipeline })
    }

    /// Fills what no surface covers.
    pub fn record(
        &self,
        recorder: &mut Recorder,
        depth: &Image,
        light: &Light<'_>,
        view: &View,
        radiance: &Image,
    ) {
        let limb = self.settings.limb_darkening;
        let push = Push {
            size: view.size.as_vec2(),
            direction: light.daylight.sun_direction.as_vec3(),
            // The mean over the disc stays: that of 1 - u (1 - mu) is 1 - u/3.
            luminance: kilo(light.daylight.sun_luminance) / (1.0 - limb / 3.0),
            sin_radius: SUN_ANGULAR_RADIUS.sin() as f32,
            limb,
            max_radiance: self.settings.precision.max_radiance(),
        };
        recorder
            .pass("background", &self.pipeline)
            .sample("sky_radiance", light.sky_radiance, Sampler::Linear)
            .uniform("view", &view.block())
            .push(&push)
            .color(radiance, Load::Keep)
            .depth_test(depth)
            .draw();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::{GpuStruct, check_layout};

    #[test]
    fn host_and_shader_agree() {
        let push = shaders::BACKGROUND_FRAG.push.expect("push");
        assert_eq!(check_layout(Push::FIELDS, push), Ok(()));
    }

    #[test]
    fn only_whole_pictures_have_a_sky() {
        let drawn: Vec<Show> = [Show::ADDENDS.as_slice(), &Show::INPUTS]
            .concat()
            .into_iter()
            .filter(|s| content(*s).0)
            .collect();
        assert_eq!(drawn, [Show::Background]);
    }
}
