//! Lighting: per pixel, the terms T (L_e + L_sun + L_sky + L_bounces) + L_air of the illumination model on the crate's first page, one of them, or
//! one of its inputs. The background is L_e where no surface is; in converging frames the dome adds L_bounces and the diffuse part of L_sky.
//!
//! With [`Ambient::Cells`] the irradiances of sky and bounces are those of the cells. With [`Ambient::Ssao`] it is the lecture's
//! model:
//!
//! L_r = ρ_d/π ((n·l) V E_sun + A E_sky(n)) + ρ_s ((r·l)^p V E_sun + L_sky(r))

use std::sync::Arc;

use glam::{IVec2, Vec3};

use crate::daylight::false_colour::Quantity;
use crate::daylight::sky::Daylight;
use crate::gpu::{
    Context, Depth, Format, Image, ImageDesc, Load, Pipeline, Recorder, Result, Sampler, shaders,
};
use crate::gpu_struct;

use crate::passes::bounces::tree::{RayConstants, Tree};
use crate::passes::dome::gather::BIAS_TEXELS;
use crate::passes::dome::specular::{Mirrors, Phong, Reflections};
use crate::passes::light::panes::{self, BeforePicture};
use crate::passes::light::rough;
use crate::passes::sky::air::AirBefore;
pub use crate::passes::sun_shadow::cascades::Shadows;
use crate::passes::sun_shadow::cascades::{BLEND, MAX_RADIUS, PLANE_OFFSET_TEXELS, SunViews};
use crate::passes::surfaces::gbuffer::Surfaces;
pub use crate::passes::surfaces::geometry::EmissionSource;
use crate::passes::surfaces::geometry::Geometry;
use crate::passes::surfaces::upload::MATERIAL_COLUMNS;
use crate::passes::view::View;
use crate::passes::{Screen, kilo, screen};

gpu_struct! {
    /// The sun and its shadow map.
    pub struct SunBlock: sun of LIGHTING_FRAG, LIGHTING_COMP, LIGHTING_COMP_FLOAT {
        shadow_from_world: [[f32; 4]; 4],
        direction: Vec3,
        illuminance: Vec3,
        depth_bias: f32,
        max_radiance: f32,
        specular_scale: f32,
        planes: [[f32; 4]; 4],
        occlusion_from: IVec2,
    }
}

/// The quantity shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Show {
    /// The whole picture, cd/m².
    #[default]
    Beauty,
    /// ρ_d/π (n·l) V E_sun, cd/m².
    Sun,
    /// ρ_d/π A E_sky(n), the light of the visible sky, cd/m².
    Sky,
    /// ρ_d/π E_bounces, the light that other surfaces reflect, cd/m².
    Bounces,
    /// L_e, the light that surfaces emit, cd/m².
    Emission,
    /// ρ_s (r·l)^p V E_sun, or that in the lobe of GGX, cd/m².
    SunSpecular,
    /// ρ_s L_sky(r), the light of sky and surfaces in lobes of GGX, and what panes of glass mirror, cd/m².
    SkySpecular,
    /// L_air, the light that the air scatters between surface and eye, cd/m².
    Air,
    /// Sky, ground and the sun's disc in pixels without a surface, cd/m².
    Background,
    /// V, 0..1.
    Visibility,
    /// A, the fraction of the sky's light that is visible, 0..1.
    Occlusion,
    /// (n·l) V E_sun + A E_sky(n) + E_bounces, lux.
    Irradiance,
    /// ρ_d, 0..1.
    Albedo,
    /// World normal on the viewer's side, −1..1.
    Normal,
    /// Distance along the view axis, metres; 0 is background.
    Depth,
    /// Luminance of the whole picture, cd/m², in grey.
    Luminance,
    /// V of frames with different suns, whose mean is the share of the hours of sun, 0..1; −1 without a surface.
    SunHours,
}

impl Show {
    /// The terms of the picture: they sum to [`Show::Beauty`].
    pub const ADDENDS: [Self; 8] = [
        Self::Sun,
        Self::Sky,
        Self::Bounces,
        Self::Emission,
        Self::SunSpecular,
        Self::SkySpecular,
        Self::Air,
        Self::Background,
    ];

    /// The inputs of the equation, in the order in which files list them.
    pub const INPUTS: [Self; 6] = [
        Self::Visibility,
        Self::Occlusion,
        Self::Irradiance,
        Self::Albedo,
        Self::Normal,
        Self::Depth,
    ];

    /// Conversion factor from device to file units: kcd/m² to cd/m², klx to lux.
    pub fn file_unit(self) -> f32 {
        match self {
            Self::Visibility
            | Self::Occlusion
            | Self::Albedo
            | Self::Normal
            | Self::Depth
            | Self::SunHours => 1.0,
            _ => 1000.0,
        }
    }

    /// Whether the light that other surfaces reflect is part of it.
    pub fn has_bounces(self) -> bool {
        matches!(
            self,
            Self::Beauty | Self::Luminance | Self::Bounces | Self::Irradiance
        )
    }

    /// Whether the values shown are a `quantity`.
    pub fn holds(self, quantity: Quantity) -> bool {
        match quantity {
            Quantity::Luminance => self.file_unit() != 1.0 && self != Self::Irradiance,
            Quantity::Illuminance => self == Self::Irradiance,
            Quantity::SunHours => self == Self::SunHours,
        }
    }

    /// Whether what surfaces and panes of glass mirror of the sky is part of it.
    pub(in crate::passes) fn is_mirrored(self) -> bool {
        matches!(self, Self::Beauty | Self::Luminance | Self::SkySpecular)
    }

    fn constants(self, specular: bool, emits: bool) -> [(&'static str, u32); 13] {
        let whole = matches!(self, Self::Beauty | Self::Luminance);
        let on = |shown: Self| u32::from(self == shown);
        let addend = |shown: Self| u32::from(whole || self == shown);
        [
            ("SUN", addend(Self::Sun)),
            ("SKY", addend(Self::Sky)),
            ("BOUNCES", addend(Self::Bounces)),
            ("EMISSION", u32::from(emits) & addend(Self::Emission)),
            (
                "SUN_SPECULAR",
                u32::from(specular) & addend(Self::SunSpecular),
            ),
            (
                "SKY_SPECULAR",
                u32::from(specular) & addend(Self::SkySpecular),
            ),
            ("INSCATTER", addend(Self::Air)),
            ("SHOW_VISIBILITY", on(Self::Visibility) | on(Self::SunHours)),
            ("SHOW_OCCLUSION", on(Self::Occlusion)),
            ("SHOW_IRRADIANCE", on(Self::Irradiance)),
            ("SHOW_ALBEDO", on(Self::Albedo)),
            ("SHOW_NORMAL", on(Self::Normal)),
            ("SHOW_DEPTH", on(Self::Depth)),
        ]
    }
}

/// Precision of radiance on the device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// Half floats, for display. The sun's disc is clamped to 65 504 kcd/m².
    Half,
    /// 32-bit floats, for files and sums.
    Float,
}

impl Precision {
    pub(in crate::passes) fn format(self) -> Format {
        match self {
            Self::Half => Format::R16G16B16A16_SFLOAT,
            Self::Float => Format::R32G32B32A32_SFLOAT,
        }
    }

    /// Largest radiance the format can represent, kcd/m².
    pub(in crate::passes) fn max_radiance(self) -> f32 {
        match self {
            Self::Half => 65_504.0,
            Self::Float => f32::MAX,
        }
    }
}

/// Where single frames have the light of the sky and of other surfaces from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Ambient {
    /// Cells of irradiance in world space: the true visibility of the sky, and bounces.
    #[default]
    Cells,
    /// Screen-space ambient occlusion of the unoccluded sky, without bounces: the lecture's A.
    Ssao,
}

/// Settings of the lighting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightingSettings {
    /// The quantity shown.
    pub show: Show,
    /// Precision of the result.
    pub precision: Precision,
    /// Factor on every ρ_s. 0 disables the lookups; [`crate::frame::Frame`] sets it for scenes without any ρ_s.
    pub specular_scale: f32,
    /// Limb darkening of the sun's disc, u of I = I₀ (1 − u (1 − cos θ)); 0: a uniform disc.
    pub limb_darkening: f32,
    /// Source of the light of the sky and of other surfaces in single frames.
    pub ambient: Ambient,
    /// Pixels per texel of A, along each axis: [`crate::passes::occlusion::ssao::SsaoSettings::pixels_per_texel`].
    pub occlusion_downscale: u32,
    /// Whether the scene has materials that reflect by GGX. Set by [`crate::frame::Frame`].
    pub rough: bool,
    /// Whether ρ_d is stored per pixel. Set by [`crate::frame::Frame`]; false for scenes without maps.
    pub has_albedo: bool,
    /// Where L_e of surfaces is. Set by [`crate::frame::Frame`].
    pub emission: EmissionSource,
    /// Factor on what panes of glass mirror, if there are any. Set by [`crate::frame::Frame`].
    pub panes: Option<f32>,
    /// Whether the air between surface and eye is drawn. [`crate::frame::Frame`] clears it for scenes without far surfaces.
    pub air: bool,
    /// Whether ρ_s grows toward grazing angles (Schlick's approximation of Fresnel's equations).
    pub fresnel: bool,
    /// Settings of the sun's shadow lookup.
    pub shadows: Shadows,
    /// Settings of the specular terms.
    pub mirrors: Mirrors,
    /// Whether rays find what is before the sun in converging frames; the map then holds cut-outs alone. Set by [`crate::frame::Frame`].
    pub sun_by_rays: bool,
    /// Whether the scene has cut-outs. Set by [`crate::frame::Frame`].
    pub cut_outs: bool,
}

impl LightingSettings {
    /// Whether light in the lobes of GGX is shown, other than that of the sun.
    pub fn has_lobes(&self) -> bool {
        self.rough && self.specular_scale > 0.0 && self.show.is_mirrored()
    }

    /// Constants of pipelines with `include/microfacet.glsl`.
    pub(in crate::passes) fn lobe_constants(&self) -> [(&'static str, u32); 3] {
        rough::constants(self.rough, self.specular_scale)
    }
}

/// Light sources at a moment: parameters and images.
#[derive(Clone, Copy)]
pub struct Light<'a> {
    /// Daylight at that moment.
    pub daylight: &'a Daylight,
    /// Unit vector toward the point of the sun's disc that this frame samples.
    pub sun_direction: Vec3,
    /// The sun's shadow views.
    pub sun_views: &'a SunViews,
    /// The sun's shadow map: depth of those views.
    pub shadow_map: &'a Image,
    /// Irradiance E of sky and ground, klx.
    pub sky_irradiance: &'a Image,
    /// Radiance L of sky and ground, kcd/m².
    pub sky_radiance: &'a Image,
    /// Whether rays decide at the edges of shadows: not while the view moves.
    pub traces: bool,
    /// Panes of glass before the picture.
    pub panes: BeforePicture<'a>,
    /// What panes let through of the sun's light, in the views of its shadow map; `None` without panes.
    pub sun_glass: Option<&'a Image>,
    /// The air before the eye.
    pub air: AirBefore<'a>,
    /// The sky prefiltered for lobes of GGX, kcd/m²; `None` without any.
    pub sky_prefiltered: Option<&'a Image>,
    /// Light of sky and surfaces in those lobes, kcd/m², if it is shown.
    pub lobes: Option<&'a Image>,
}

impl<'a> Light<'a> {
    /// What panes of glass mirror.
    pub fn surroundings(&self) -> panes::Surroundings<'a> {
        panes::Surroundings {
            sun_direction: self.sun_direction,
            sun_illuminance: self.daylight.direct_light().illuminance,
            sky_irradiance: self.sky_irradiance,
            sky_radiance: self.sky_radiance,
        }
    }
}

/// The lighting pass and its picture.
pub struct Lighting {
    settings: LightingSettings,
    /// Without rays at the edges of shadows: a constant, since branches that are not taken cost registers too.
    moving: Pipeline,
    tracing: Pipeline,
    radiance: Image,
}

impl Lighting {
    /// Creates the pass for a picture of `size` pixels.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(
        context: &Arc<Context>,
        rays: RayConstants,
        size: [u32; 2],
        settings: LightingSettings,
    ) -> Result<Self> {
        Self::with(context, rays, size, settings, false)
    }

    /// Creates the pass for converging frames: without diffuse sky light (A = 0), which [`crate::passes::dome::gather::Dome`] adds,
    /// and with hard shadows from the map of [`crate::passes::sun_shadow::map::Shadow::perspective`].
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn converging(
        context: &Arc<Context>,
        rays: RayConstants,
        size: [u32; 2],
        settings: LightingSettings,
    ) -> Result<Self> {
        Self::with(context, rays, size, settings, true)
    }

    fn with(
        context: &Arc<Context>,
        rays: RayConstants,
        size: [u32; 2],
        settings: LightingSettings,
        is_converging: bool,
    ) -> Result<Self> {
        let format = settings.precision.format();
        let constants = Self::constants(&settings, rays, is_converging);
        let pipeline = |traces: bool| {
            // PLANE_SHADOW, which converging frames set, leaves TRACES without effect: one pipeline serves both.
            let traces = traces && !is_converging;
            let constants = [&constants[..], &[("TRACES", traces.into())]].concat();
            let depth = Depth::Surface(Format::D32_SFLOAT);
            let shaders = Screen {
                fragment: &shaders::LIGHTING_FRAG,
                compute: match settings.precision {
                    Precision::Half => &shaders::LIGHTING_COMP,
                    Precision::Float => &shaders::LIGHTING_COMP_FLOAT,
                },
            };
            screen(context, "lighting", shaders, &[format], depth, &constants)
        };
        let desc = ImageDesc::flat("radiance", format, size);
        let radiance = Image::new(context, &desc.target_by(context.route()))?;
        Ok(Self {
            settings,
            moving: pipeline(false)?,
            tracing: pipeline(true)?,
            radiance,
        })
    }

    fn constants(
        settings: &LightingSettings,
        rays: RayConstants,
        is_converging: bool,
    ) -> Vec<(&'static str, u32)> {
        let mut constants = settings
            .show
            .constants(
                settings.specular_scale > 0.0,
                settings.emission != EmissionSource::None,
            )
            .to_vec();
        let has_factor = settings.emission == EmissionSource::Image;
        constants.push(("EMISSION_IMAGE", has_factor.into()));
        constants.push(("OCCLUSION_DOWNSCALE", settings.occlusion_downscale));
        let Mirrors { phong, reflections } = settings.mirrors;
        if is_converging && reflections == Reflections::Hidden {
            constants.retain(|constant| constant.0 != "SKY_SPECULAR");
            constants.push(("SKY_SPECULAR", 0));
        }
        constants.push(("NORMALIZED", (phong == Phong::Normalized).into()));
        constants.push(("AIR", settings.air.into()));
        constants.push(("FRESNEL", settings.fresnel.into()));
        constants.push(("ALBEDO_IMAGE", settings.has_albedo.into()));
        constants.push(("AMBIENT", (!is_converging).into()));
        constants.push(("CELLS", (settings.ambient == Ambient::Cells).into()));
        constants.push(("PLANE_SHADOW", is_converging.into()));
        constants.push(("SUN_BY_RAYS", settings.sun_by_rays.into()));
        constants.push(("CUT_OUTS", settings.cut_outs.into()));
        constants.push(("MIRRORED", settings.show.is_mirrored().into()));
        constants.push(("PANES", settings.panes.is_some().into()));
        constants.push(("CASCADES", settings.shadows.cascades.max(1)));
        constants.push(("PCSS", settings.shadows.penumbrae.into()));
        constants.push(("PLANE_OFFSET", PLANE_OFFSET_TEXELS.to_bits()));
        constants.push(("BLEND", BLEND.to_bits()));
        constants.push(("MAX_RADIUS", MAX_RADIUS.to_bits()));
        constants.push(("MATERIAL_COLUMNS", MATERIAL_COLUMNS));
        constants.push(("LOBES", settings.has_lobes().into()));
        constants.extend(settings.lobe_constants());
        constants.extend(rays);
        constants
    }

    /// Lights the surfaces; [`crate::passes::light::background::Background`] fills the other pixels. The fourth channel is the
    /// illuminance of the surface, klx.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        (geometry, tree): (&Geometry, &Tree),
        surfaces: &Surfaces,
        ambient: &Image,
        light: &Light<'_>,
        view: &View,
    ) -> &Image {
        let materials = geometry.materials();
        let pipeline = if light.traces {
            &self.tracing
        } else {
            &self.moving
        };
        let pass = tree.bound_to(recorder.pass("lighting", pipeline));
        let pass = light.panes.sampled_by(pass, materials);
        let sun_glass = light.sun_glass.unwrap_or(materials);
        let pass = surfaces.sampled_by(pass, materials);
        light
            .air
            .sampled_by(pass, materials)
            .sample(
                "emission",
                surfaces.emission_or(materials),
                Sampler::Nearest,
            )
            .sample("ambient", ambient, Sampler::Nearest)
            .sample("shadow_map", light.shadow_map, Sampler::Nearest)
            .sample("sun_glass", sun_glass, Sampler::Nearest)
            .sample("lobes", light.lobes.unwrap_or(materials), Sampler::Nearest)
            .sample("sky_irradiance", light.sky_irradiance, Sampler::Linear)
            .sample("sky_radiance", light.sky_radiance, Sampler::Linear)
            .uniform("view", &view.block())
            .uniform("sun", &self.sun_block(light, view))
            .uniform("cascades", &light.sun_views.block())
            .output("radiance", &self.radiance, Load::Discard)
            .selected_by(&surfaces.depth)
            .fill();
        &self.radiance
    }

    fn sun_block(&self, light: &Light<'_>, view: &View) -> SunBlock {
        let shadow = light.sun_views.first();
        SunBlock {
            shadow_from_world: shadow.shadow_from_world.to_cols_array_2d(),
            direction: light.sun_direction,
            illuminance: kilo(light.daylight.direct_light().illuminance),
            depth_bias: BIAS_TEXELS * shadow.texel_depth,
            max_radiance: self.settings.precision.max_radiance(),
            specular_scale: self.settings.specular_scale,
            planes: shadow.planes().to_cols_array_2d(),
            // Tiles share the occlusion image of the whole picture.
            occlusion_from: view.window.map_or(IVec2::ZERO, |w| w.origin.as_ivec2()),
        }
    }

    /// The picture, kcd/m².
    pub fn image(&self) -> &Image {
        &self.radiance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_addend_is_in_the_picture_once() {
        let beauty = Show::Beauty.constants(true, true);
        for (i, addend) in Show::ADDENDS.iter().take(7).enumerate() {
            let constants = addend.constants(true, true);
            assert_eq!(beauty[i].1, 1);
            assert_eq!(constants[i].1, 1, "{addend:?}");
            assert_eq!(constants.iter().map(|c| c.1).sum::<u32>(), 1, "{addend:?}");
        }
    }
}
