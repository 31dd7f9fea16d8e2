//! Settings of a frame, and constructors of passes from them.

use std::sync::Arc;

use glam::UVec2;

use super::ambient::AmbientNeed;
use super::{AntiAliasing, Sampling, Visibility};
use crate::gpu::{Context, Result};
use crate::passes::bounces::cells::{Bounces, Cells};
use crate::passes::bounces::tree::{RayConstants, TreeFacts};
use crate::passes::dome::route::{DomeBy, Work};
use crate::passes::dome::specular::{Mirrors, Reflections};
use crate::passes::light::background::Background;
use crate::passes::light::lighting::{
    Ambient, EmissionSource, Lighting, LightingSettings, Precision, Shadows, Show,
};
use crate::passes::light::lobes::{Lobes, LobesNeed};
use crate::passes::light::panes::Panes;
use crate::passes::occlusion::ssao::SsaoSettings;
use crate::passes::picture::tone_map::{ToneMap, ToneSettings, is_light};
use crate::passes::sky::air::{Air, LEAST_SCENE};
use crate::passes::sky::irradiance::IrradianceSettings;
use crate::passes::sun_shadow::cascades;
use crate::passes::sun_shadow::map::Shadow;
use crate::passes::surfaces::facts::Facts;
use crate::passes::surfaces::gbuffer::Gbuffer;

/// Settings that stay the same from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameSettings {
    /// Width and height, pixels.
    pub size: UVec2,
    /// Width and height of the picture of which frames are tiles, pixels; `None`: frames are whole. What suits a picture must suit all tiles.
    pub of_picture: Option<UVec2>,
    /// Number of frames averaged into a picture; 1 samples the pixel centres and the sun's centre.
    pub samples: u32,
    /// How the frames differ, and how the sky's visibility is computed.
    pub sampling: Sampling,
    /// Edge of a face of the sky cube, texels.
    pub sky_edge: u32,
    /// The irradiance cube.
    pub irradiance: IrradianceSettings,
    /// Edge of the shadow map, texels.
    pub shadow_resolution: u32,
    /// Ambient occlusion.
    pub ssao: SsaoSettings,
    /// How often light is reflected between surfaces.
    pub bounces: Bounces,
    /// Light paths that refine the cells in a frame outside of any average.
    pub refine: u32,
    /// Lighting.
    pub lighting: LightingSettings,
    /// Tone mapping and exposure.
    pub tone: ToneSettings,
    /// Anti-aliasing of what is displayed of single frames and moving views.
    pub aa: AntiAliasing,
}

impl Default for FrameSettings {
    /// One frame of 1280x720 pixels, with automatic exposure.
    fn default() -> Self {
        let (show, ssao) = (Show::Beauty, SsaoSettings::default());
        Self {
            size: UVec2::new(1280, 720),
            of_picture: None,
            samples: 1,
            sampling: Sampling::default(),
            sky_edge: 256,
            irradiance: IrradianceSettings::default(),
            shadow_resolution: 2048,
            ssao,
            bounces: Bounces::All,
            refine: 4096,
            lighting: LightingSettings {
                show,
                precision: Precision::Half,
                ambient: Ambient::default(),
                specular_scale: 1.0,
                limb_darkening: 0.0,
                rough: false,
                has_albedo: true,
                panes: None,
                emission: EmissionSource::None,
                occlusion_downscale: ssao.pixels_per_texel(),
                air: false,
                fresnel: false,
                shadows: Shadows::default(),
                mirrors: Mirrors::default(),
                sun_by_rays: false,
                cut_outs: false,
            },
            tone: ToneSettings::default(),
            aa: AntiAliasing::default(),
        }
    }
}

impl FrameSettings {
    /// These settings, showing another quantity.
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

    /// Whether the picture is the plain mean of its frames ([`crate::passes::picture::accumulate::Accumulate`]).
    pub(super) fn takes_mean(&self) -> bool {
        self.samples > 1 && self.sampling.visibility == Visibility::Ssao
    }

    /// Whether the mean of the frames converges to the true visibility of the sky ([`crate::passes::dome::gather::Dome`]).
    pub(super) fn converges(&self) -> bool {
        self.sampling.visibility != Visibility::Ssao
    }

    /// Whether frames of an average are combined at all.
    pub(super) fn averages(&self) -> bool {
        self.takes_mean() || self.converges()
    }

    /// The bounces that rays gather in converging frames: those of the settings if the quantity shown has them.
    pub(super) fn gathered(&self) -> Bounces {
        let is_shown = self.lighting.show.has_bounces() || self.sampling.dome.illuminance;
        if self.converges() && is_shown {
            self.bounces
        } else {
            Bounces::UpTo(0)
        }
    }

    /// The bounces of the cells: one less where rays are the first one.
    pub(super) fn cell_bounces(&self, is_gathered: bool) -> Bounces {
        if is_gathered {
            self.bounces.after_one()
        } else {
            self.bounces
        }
    }

    /// The seed of the cells; `None` if no light is looked up in them.
    pub(super) fn cells_need(&self) -> Option<u32> {
        let is_mirrored = self.converges() && self.lighting.has_lobes() && self.bounces.is_any();
        let is_needed =
            self.gathered().is_any() || AmbientNeed::of(self) == AmbientNeed::Cells || is_mirrored;
        is_needed.then_some(self.sampling.dome.seed)
    }

    /// The cells, if any light is looked up in them.
    pub(super) fn cells(
        &self,
        context: &Arc<Context>,
        tree: &TreeFacts,
        facts: &Facts,
    ) -> Result<Option<Cells>> {
        let seed = self.cells_need();
        seed.map(|seed| Cells::new(context, tree, &facts.bounds, seed))
            .transpose()
    }

    /// The settings that the shadow map of single frames depends on.
    pub(super) fn shadow_map(&self) -> (u32, Shadows) {
        (self.shadow_resolution, self.lighting.shadows)
    }

    /// The shadow map of single frames.
    pub(super) fn shadow(&self, context: &Arc<Context>, facts: &Facts) -> Result<Shadow> {
        let (resolution, shadows) = self.shadow_map();
        Shadow::cascades(context, facts, resolution, shadows)
    }

    /// Whether the G-buffer has the slopes of faces.
    pub(super) fn has_faces(&self) -> bool {
        self.converges() || self.lighting.has_lobes()
    }

    /// Whether the depth of the frame before is kept.
    pub(super) fn keeps_depth(&self) -> bool {
        self.anti_aliasing() == AntiAliasing::Taa
    }

    /// The anti-aliasing: none of quantities and false colours, whose values between two surfaces would mean nothing.
    pub(super) fn anti_aliasing(&self) -> AntiAliasing {
        let is_picture = is_light(self.tone.show) && self.tone.false_colour.is_none();
        if is_picture {
            self.aa
        } else {
            AntiAliasing::Off
        }
    }

    /// What the anti-aliasing depends on.
    pub(super) fn smooth_need(&self) -> (UVec2, AntiAliasing, bool) {
        (self.size, self.anti_aliasing(), self.tone.peak.is_some())
    }

    /// The G-buffer.
    pub(super) fn gbuffer(&self, context: &Arc<Context>, facts: &Facts) -> Result<Gbuffer> {
        let kinds = (self.has_faces(), self.keeps_depth());
        Gbuffer::new(context, facts, self.size.to_array(), kinds)
    }

    /// What the light in the lobes of GGX depends on; `None` if it is not shown.
    pub(super) fn lobes_need(&self) -> Option<LobesNeed> {
        self.lighting.has_lobes().then_some(LobesNeed {
            lighting: self.lighting,
            bounces: self.bounces,
            seed: self.sampling.dome.seed,
            is_single: self.sampling.visibility != Visibility::Dome,
            converges: self.converges(),
        })
    }

    /// The light in the lobes of GGX, if it is shown.
    pub(super) fn lobes(&self, context: &Arc<Context>, tree: &TreeFacts) -> Result<Option<Lobes>> {
        let size = self.size.to_array();
        let need = self.lobes_need();
        need.map(|need| Lobes::new(context, tree, size, &need))
            .transpose()
    }

    /// Lighting of single frames.
    pub(super) fn lighting(&self, context: &Arc<Context>, rays: RayConstants) -> Result<Lighting> {
        Lighting::new(context, rays, self.size.to_array(), self.lighting)
    }

    /// The background.
    pub(super) fn background(&self, context: &Arc<Context>) -> Result<Background> {
        Background::new(context, self.lighting)
    }

    /// Panes of glass, if the scene has any.
    pub(super) fn panes(&self, context: &Arc<Context>, tree: &TreeFacts) -> Result<Option<Panes>> {
        let size = self.size.to_array();
        let panes = self.lighting.panes;
        panes
            .map(|scale| Panes::new(context, tree, size, scale))
            .transpose()
    }

    /// Edge of a face of the sky behind the air; `None` if the air is not drawn.
    pub(super) fn air_need(&self) -> Option<u32> {
        self.lighting.air.then_some(self.sky_edge)
    }

    /// The air before the eye, if it is drawn.
    pub(super) fn air(&self, context: &Arc<Context>, facts: &Facts) -> Result<Option<Air>> {
        let edge = self.air_need();
        edge.map(|edge| Air::new(context, &facts.bounds, edge))
            .transpose()
    }

    /// Tone mapping.
    pub(super) fn tone_map(&self, context: &Arc<Context>) -> Result<ToneMap> {
        ToneMap::new(context, self.size.to_array(), self.tone)
    }

    /// Adjusts the settings to a scene: no specular lookups without ρ_s, no albedo image without textures, no emission without L_e, no air in
    /// small scenes, cascades for large ones, maps or rays of the dome.
    pub(super) fn for_scene(mut self, context: &Context, facts: &Facts) -> Self {
        let shadows = &mut self.lighting.shadows;
        if shadows.cascades == 0 {
            let most = context.summary().max_image_edge;
            shadows.cascades = cascades::count(&facts.casters, self.shadow_resolution, most);
        }
        let panes = facts.has_panes;
        self.lighting.panes = panes.then_some(self.lighting.specular_scale);
        self.lighting.rough = facts.is_rough;
        if !facts.is_specular {
            self.lighting.specular_scale = 0.0;
        }
        self.lighting.air &= facts.bounds.diagonal() >= LEAST_SCENE;
        self.lighting.has_albedo = facts.has_albedo();
        self.lighting.emission = facts.emission_source;
        self.sampling.dome.by = self.dome_by(facts, context.is_short_of_raster_units());
        self.lighting.sun_by_rays = self.converges() && self.sampling.dome.by == DomeBy::Rays;
        self.lighting.cut_outs = facts.has_cut_outs();
        self
    }

    /// Maps or rays of the dome: what serves better, but maps where lobes look light up in them.
    fn dome_by(&self, facts: &Facts, is_short_of_raster_units: bool) -> DomeBy {
        if self.lighting.mirrors.reflections == Reflections::Hidden {
            return DomeBy::Maps;
        }
        let (size, dome) = (self.of_picture.unwrap_or(self.size), self.sampling.dome);
        dome.by.chosen(Work {
            triangles: facts.casting_triangles,
            pixels: u64::from(size.x) * u64::from(size.y),
            texels: u64::from(dome.map_edge).pow(2),
            texel: facts.casters.extent().max_element() / dome.map_edge as f32,
            is_short_of_raster_units,
        })
    }
}
