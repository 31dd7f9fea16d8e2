//! Specular reflection of the sky: the lobe's shape, and the sky's visibility within the lobe.
//!
//! The lecture's illumination model reflects the unoccluded sky, ρ_s L_sky(r); its rendering equation includes visibility,
//! ρ_s V(x, r) L_sky(r). The pass estimates V with the shadow maps of [`crate::passes::dome::gather`], as the visible fraction of
//! the sky light in the lobe around r, over all directions so far.

use std::sync::Arc;

use glam::Vec2;

use crate::daylight::sampling;
use crate::gpu::{
    Context, Depth, Format, Image, ImageDesc, Load, Pipeline, Recorder, Result, Sampler, shaders,
};
use crate::gpu_struct;

use crate::passes::dome::gather::{DomeBlock, DomeSettings, Gathered};
use crate::passes::light::lighting::LightingSettings;
use crate::passes::surfaces::upload::MATERIAL_COLUMNS;
use crate::passes::view::View;
use crate::passes::{Screen, screen};

/// The specular lobe.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Phong {
    /// By the format of the model: GGX for glTF, whose materials it describes, and the lecture's for MTL.
    #[default]
    ByFormat,
    /// The lecture's: (r·l)^p for the sun, and a perfect mirror for the sky.
    Lecture,
    /// Energy-conserving: ρ_s (p + 2)/(2π) (r·l)^p cos θ for both sun and sky.
    Normalized,
}

/// The sky's visibility in specular reflections.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Reflections {
    /// Unoccluded, as in the lecture's illumination model.
    #[default]
    Open,
    /// Occluded by surfaces, as in the lecture's rendering equation (--visibility dome).
    Hidden,
}

/// Settings of the specular terms.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Mirrors {
    /// The lobe.
    pub phong: Phong,
    /// The sky's visibility within the lobe.
    pub reflections: Reflections,
}

gpu_struct! {
    /// Noise and weight of this frame, scale of ρ_s.
    pub struct Push: push of DOME_SPECULAR_FRAG, DOME_SPECULAR_COMP {
        shift: Vec2,
        share: f32,
        specular_scale: f32,
    }
}

const FORMATS: [Format; 2] = [Format::R32G32B32A32_SFLOAT, Format::R32_SFLOAT];

/// The sky reflection passes and their means.
pub(in crate::passes) struct SpecularSky {
    lighting: LightingSettings,
    gather: Pipeline,
    resolve: Pipeline,
    /// Alternating means: reflection of the unoccluded sky with the visible light in the lobe, and all light in the lobe.
    means: [[Image; 2]; 2],
    radiance: Image,
}

impl SpecularSky {
    /// `None` if the quantity shown includes no sky reflection with visibility.
    pub fn new(
        context: &Arc<Context>,
        size: [u32; 2],
        dome: DomeSettings,
        lighting: LightingSettings,
    ) -> Result<Option<Self>> {
        let is_shown = lighting.show.is_mirrored();
        let hidden = lighting.mirrors.reflections == Reflections::Hidden;
        if !(is_shown && hidden && lighting.specular_scale > 0.0) {
            return Ok(None);
        }
        let image = |name, format| {
            let desc = ImageDesc::flat(name, format, size);
            Image::new(context, &desc.target_by(context.route()))
        };
        let pair = || -> Result<[Image; 2]> {
            Ok([
                image("reflected sky", FORMATS[0])?,
                image("lobe", FORMATS[1])?,
            ])
        };
        let name = "dome: resolve specular";
        let resolve = Screen {
            fragment: &shaders::DOME_SPECULAR_RESOLVE_FRAG,
            compute: &shaders::DOME_SPECULAR_RESOLVE_COMP,
        };
        Ok(Some(Self {
            lighting,
            gather: gather_pipeline(context, dome, lighting)?,
            resolve: screen(context, name, resolve, &FORMATS[..1], Depth::Off, &[])?,
            means: [pair()?, pair()?],
            radiance: image("radiance with specular", FORMATS[0])?,
        }))
    }

    /// Adds frame number `index` to the means, and the resulting reflection to `picture`.
    #[allow(clippy::too_many_arguments)]
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        gathered: &Gathered<'_>,
        view: &View,
        (maps, block): (&Image, &DomeBlock),
        picture: &Image,
        index: u32,
    ) {
        self.means.swap(0, 1);
        let [[reflected, lobe], [old_reflected, old_lobe]] = &self.means;
        let pass = recorder.pass("dome: specular", &self.gather);
        let pass = gathered.panes.sampled_by(pass, gathered.materials);
        let pass = gathered.surfaces.sampled_by(pass, gathered.materials);
        gathered
            .air
            .sampled_by(pass, gathered.materials)
            .sample("previous_reflected", old_reflected, Sampler::Nearest)
            .sample("previous_lobe", old_lobe, Sampler::Nearest)
            .sample("maps", maps, Sampler::Nearest)
            .sample("sky_radiance", gathered.sky_radiance, Sampler::Linear)
            .uniform("view", &view.block())
            .uniform("dome", block)
            .push(&Push {
                shift: sampling::r2(index).as_vec2(),
                share: 1.0 / (index + 1) as f32,
                specular_scale: self.lighting.specular_scale,
            })
            .output("new_reflected", reflected, Load::Discard)
            .output("new_lobe", lobe, Load::Discard)
            .fill();
        recorder
            .pass("dome: resolve specular", &self.resolve)
            .sample("picture", picture, Sampler::Nearest)
            .sample("reflected", reflected, Sampler::Nearest)
            .sample("lobe", lobe, Sampler::Nearest)
            .output("radiance", &self.radiance, Load::Discard)
            .fill();
    }

    /// The picture with specular reflections, kcd/m².
    pub fn image(&self) -> &Image {
        &self.radiance
    }
}

fn gather_pipeline(
    context: &Arc<Context>,
    dome: DomeSettings,
    lighting: LightingSettings,
) -> Result<Pipeline> {
    let normalized = lighting.mirrors.phong == Phong::Normalized;
    screen(
        context,
        "dome: specular",
        Screen {
            fragment: &shaders::DOME_SPECULAR_FRAG,
            compute: &shaders::DOME_SPECULAR_COMP,
        },
        &FORMATS,
        Depth::Off,
        &[
            ("DIRECTIONS", dome.directions),
            ("AIR", lighting.air.into()),
            ("FRESNEL", lighting.fresnel.into()),
            ("NORMALIZED", normalized.into()),
            ("ALBEDO_IMAGE", lighting.has_albedo.into()),
            ("PANES", lighting.panes.is_some().into()),
            ("MATERIAL_COLUMNS", MATERIAL_COLUMNS),
        ],
    )
}
