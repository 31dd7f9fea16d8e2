//! How frames are drawn.

use std::sync::Arc;

use glam::UVec2;

use super::{Sampling, Visibility};
use crate::daylight::exposure::KEY;
use crate::daylight::tone_curve::{REINHARD_WHITE, ToneCurve};
use crate::gpu::{Context, Result};
use crate::passes::dome::specular::Mirrors;
use crate::passes::light::lighting::{LightingSettings, Precision, Shadows, Show};
use crate::passes::occlusion::ssao::SsaoSettings;
use crate::passes::picture::tone_map::{Scale, ToneSettings};
use crate::passes::sky::irradiance::IrradianceSettings;
use crate::passes::sun_shadow::cascades;
use crate::passes::sun_shadow::map::Shadow;
use crate::passes::surfaces::geometry::Geometry;

/// Everything that is fixed while frames are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameSettings {
    /// Width and height, pixels.
    pub size: UVec2,
    /// Frames that are averaged into a picture; 1 samples pixel centres and the sun's centre.
    pub samples: u32,
    /// How they differ, and what hides the sky from them.
    pub sampling: Sampling,
    /// Edge of a face of the sky cube, texels.
    pub sky_edge: u32,
    /// The irradiance cube.
    pub irradiance: IrradianceSettings,
    /// Edge of the shadow map, texels.
    pub shadow_resolution: u32,
    /// Ambient occlusion.
    pub ssao: SsaoSettings,
    /// Lighting.
    pub lighting: LightingSettings,
    /// Display.
    pub tone: ToneSettings,
}

impl Default for FrameSettings {
    /// One frame of 1280x720 pixels, with automatic exposure.
    fn default() -> Self {
        let (show, ssao) = (Show::Beauty, SsaoSettings::default());
        Self {
            size: UVec2::new(1280, 720),
            samples: 1,
            sampling: Sampling::default(),
            sky_edge: 256,
            irradiance: IrradianceSettings::default(),
            shadow_resolution: 2048,
            ssao,
            lighting: LightingSettings {
                show,
                precision: Precision::Half,
                specular_scale: 1.0,
                limb_darkening: 0.0,
                has_albedo: true,
                occlusion_downscale: ssao.pixels_per_texel(),
                fresnel: false,
                shadows: Shadows::default(),
                mirrors: Mirrors::default(),
            },
            tone: ToneSettings {
                show,
                curve: ToneCurve::default(),
                scale: Scale::Average(KEY),
                white: REINHARD_WHITE,
                gamma: None,
                depth_scale: 1.0,
                false_colour: None,
            },
        }
    }
}

impl FrameSettings {
    /// These settings, to show something else.
    #[must_use]
    pub fn showing(mut self, show: Show) -> Self {
        (self.lighting.show, self.tone.show) = (show, show);
        self
    }

    /// These settings with other ambient occlusion.
    #[must_use]
    pub fn with_occlusion(mut self, ssao: SsaoSettings) -> Self {
        self.lighting.occlusion_downscale = ssao.pixels_per_texel();
        self.ssao = ssao;
        self
    }

    /// Whether frames are averaged by [`crate::passes::picture::accumulate::Accumulate`].
    pub(super) fn averages(&self) -> bool {
        self.samples > 1 && self.sampling.visibility == Visibility::Ssao
    }

    /// Whether the mean of its frames has the sky's true visibility ([`crate::passes::dome::gather::Dome`]).
    pub(super) fn converges(&self) -> bool {
        self.sampling.visibility != Visibility::Ssao
    }

    /// What the sun's maps are made for.
    pub(super) fn shadow_maps(&self) -> (u32, u32) {
        (self.shadow_resolution, self.lighting.shadows.cascades)
    }

    /// The sun's maps.
    pub(super) fn shadow(&self, context: &Arc<Context>, geometry: &Geometry) -> Result<Shadow> {
        let (resolution, count) = self.shadow_maps();
        Shadow::cascaded(context, geometry, resolution, count)
    }

    /// A scene without any ρ_s needs none of its lookups, one without maps no image of ρ_d; a large one has several maps of
    /// the sun.
    pub(super) fn for_scene(mut self, context: &Context, geometry: &Geometry) -> Self {
        let shadows = &mut self.lighting.shadows;
        if shadows.cascades == 0 {
            let most = context.summary().max_image_edge;
            shadows.cascades = cascades::count(geometry.casters(), self.shadow_resolution, most);
        }
        if !geometry.is_specular() {
            self.lighting.specular_scale = 0.0;
        }
        self.lighting.has_albedo = geometry.has_albedo();
        self
    }
}
