//! The background: the sky cube along each pixel's ray, the discs of sun and moon, and the stars, in pixels without a surface.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use crate::daylight::sunlight::SUN_ANGULAR_RADIUS;
use crate::gpu::{
    Context, Depth, Format, Image, Load, Pipeline, Recorder, Result, Sampler, shaders,
};
use crate::gpu_struct;

use crate::passes::light::lighting::{Light, LightingSettings, Precision, Show};
use crate::passes::light::stars::Stars;
use crate::passes::view::View;
use crate::passes::{Screen, kilo, screen};

gpu_struct! {
    /// The discs of sun and moon.
    pub struct Push: push of BACKGROUND_FRAG, BACKGROUND_COMP, BACKGROUND_COMP_FLOAT {
        size: Vec2,
        direction: Vec3,
        luminance: Vec3,
        sin_radius: f32,
        limb: f32,
        max_radiance: f32,
        moon: Vec3,
        moon_sin_radius: f32,
        moon_luminance: Vec3,
        moon_sunward: Vec3,
    }
}

/// The background pass: fills the pixels without a surface in the picture of [`crate::passes::light::lighting::Lighting`].
pub struct Background {
    settings: LightingSettings,
    /// For views without a disc.
    without_disc: Pipeline,
    with_disc: Pipeline,
    /// Where the sky is shown.
    stars: Option<Stars>,
}

/// Whether the sky is drawn; otherwise the constant value of pixels without a surface.
fn content(show: Show) -> (bool, f32) {
    match show {
        Show::Beauty | Show::Luminance | Show::Background => (true, 0.0),
        // The sky itself is never occluded.
        Show::Visibility | Show::Occlusion => (false, 1.0),
        // Surfaces without sun have 0.
        Show::SunHours => (false, -1.0),
        _ => (false, 0.0),
    }
}

impl Background {
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, settings: LightingSettings) -> Result<Self> {
        let (sky, empty) = content(settings.show);
        let pipeline = |disc: bool| {
            screen(
                context,
                "background",
                Screen {
                    fragment: &shaders::BACKGROUND_FRAG,
                    compute: match settings.precision {
                        Precision::Half => &shaders::BACKGROUND_COMP,
                        Precision::Float => &shaders::BACKGROUND_COMP_FLOAT,
                    },
                },
                &[settings.precision.format()],
                Depth::Background(Format::D32_SFLOAT),
                &[
                    ("SKY", sky.into()),
                    ("EMPTY", empty.to_bits()),
                    ("DISC", disc.into()),
                    ("PANES", settings.panes.is_some().into()),
                    ("MIRRORED", settings.show.is_mirrored().into()),
                ],
            )
        };
        Ok(Self {
            settings,
            without_disc: pipeline(false)?,
            with_disc: pipeline(true)?,
            stars: if sky {
                Stars::new(context, settings.precision.format())?
            } else {
                None
            },
        })
    }

    /// Fills the pixels without a surface.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        depth: &Image,
        light: &Light<'_>,
        view: &View,
        radiance: &Image,
    ) {
        let limb = self.settings.limb_darkening;
        let moon = light.daylight.moon;
        let push = Push {
            size: view.size.as_vec2(),
            direction: light.daylight.sun_direction.as_vec3(),
            // Preserves the mean over the disc: the mean of 1 - u (1 - mu) is 1 - u/3.
            luminance: kilo(light.daylight.sun_luminance) / (1.0 - limb / 3.0),
            sin_radius: SUN_ANGULAR_RADIUS.sin() as f32,
            limb,
            max_radiance: self.settings.precision.max_radiance(),
            moon: moon.map_or(Vec3::Y, |m| m.direction.as_vec3()),
            moon_sin_radius: moon.map_or(1.0, |m| m.angular_radius.sin()) as f32,
            moon_luminance: moon.map_or(Vec3::ZERO, |m| kilo(m.luminance)),
            moon_sunward: moon.map_or(Vec3::Y, |m| m.sunward.as_vec3()),
        };
        let pipeline = if sees(view, push.direction) || moon.is_some() && sees(view, push.moon) {
            &self.with_disc
        } else {
            &self.without_disc
        };
        let pass = recorder.pass("background", pipeline);
        let sky = light.air.sky_or(light.sky_radiance);
        light
            .panes
            .sampled_by(pass, depth)
            .sample("sky_radiance", sky, Sampler::Linear)
            .uniform("view", &view.block())
            .push(&push)
            .output("radiance", radiance, Load::Keep)
            .selected_by(depth)
            .fill();
        if let Some(stars) = &mut self.stars {
            stars.record(recorder, depth, light.daylight, view, radiance);
        }
    }
}

/// Whether a disc may be in view: within the cone around the line of sight through the picture's corners.
fn sees(view: &View, direction: Vec3) -> bool {
    let block = view.block();
    let corner = block.ray_scale.abs() + block.ray_offset.abs();
    let widest = corner.length().atan() + 2.0 * SUN_ANGULAR_RADIUS as f32;
    view.camera.forward().angle_between(direction) <= widest
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;
    use crate::scene::Camera;

    #[test]
    fn the_disc_is_drawn_where_it_may_be_in_view() {
        let camera = Camera {
            eye: Vec3::ZERO,
            target: Vec3::NEG_Z,
            fov_deg: 40.0,
            near: 0.1,
        };
        let view = View {
            camera,
            size: UVec2::new(640, 360),
            jitter: Vec2::ZERO,
            sharpen: 0.0,
            window: None,
        };
        // The corner of the picture lies 36.6 degrees off its centre.
        let off =
            |degrees: f32| Vec3::new(degrees.to_radians().sin(), 0.0, -degrees.to_radians().cos());
        assert!(sees(&view, off(0.0)) && sees(&view, off(36.0)) && sees(&view, off(37.0)));
        assert!(!sees(&view, off(38.0)) && !sees(&view, off(180.0)));
    }

    #[test]
    fn only_whole_pictures_and_the_background_have_a_sky() {
        let drawn: Vec<Show> = [Show::ADDENDS.as_slice(), &Show::INPUTS]
            .concat()
            .into_iter()
            .filter(|s| content(*s).0)
            .collect();
        assert_eq!(drawn, [Show::Background]);
    }
}
