//! Light of the sky and of surfaces in the lobes of materials that reflect by GGX ([`crate::daylight::microfacet`]).
//!
//! Converging frames trace a ray in a direction of the lobe. Single frames take the split sum of a prefiltered sky, with the sky's
//! visibility and the bounces of the diffuse light, and the ray of a mirror where the surface is smooth.

use std::sync::Arc;

use glam::IVec2;

use crate::gpu::{
    Context, Depth, Format, Image, ImageDesc, Load, Pipeline, Recorder, Result, Sampler, shaders,
};
use crate::gpu_struct;

use crate::passes::bounces::cells::{Bounces, Cells};
use crate::passes::bounces::tree::{Tree, TreeFacts};
use crate::passes::light::lighting::{Ambient, Light, LightingSettings};
use crate::passes::surfaces::gbuffer::Surfaces;
use crate::passes::surfaces::geometry::Geometry;
use crate::passes::surfaces::upload::MATERIAL_COLUMNS;
use crate::passes::view::View;
use crate::passes::{Screen, screen};

gpu_struct! {
    /// Position of the picture, number of the frame, seed.
    pub struct Push: push of LOBES_FRAG, LOBES_FRAG_CELLS, LOBES_COMP, LOBES_COMP_CELLS {
        origin: IVec2,
        index: u32,
        seed: u32,
    }
}

const FORMAT: Format = Format::R32G32B32A32_SFLOAT;

/// The pass, for single frames and for converging ones, and its image.
pub struct Lobes {
    single: Option<Variant>,
    converging: Option<Variant>,
    seed: u32,
    /// Alternating: of this frame and of the one before.
    light: [Image; 2],
}

/// A pipeline, and whether it looks up the cells.
struct Variant {
    pipeline: Pipeline,
    has_cells: bool,
}

/// What the pass depends on besides the size of the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LobesNeed {
    /// Settings of the lighting.
    pub lighting: LightingSettings,
    /// Bounces of the surfaces that rays meet.
    pub bounces: Bounces,
    /// Seed of the random numbers.
    pub seed: u32,
    /// Whether there are single frames.
    pub is_single: bool,
    /// Whether there are converging frames.
    pub converges: bool,
}

impl Lobes {
    /// Creates the pass for pictures of `size` pixels.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(
        context: &Arc<Context>,
        tree: &TreeFacts,
        size: [u32; 2],
        need: &LobesNeed,
    ) -> Result<Self> {
        let lighting = &need.lighting;
        let variant = |name, has_cells: bool, converging: bool| {
            let shaders = if has_cells {
                Screen {
                    fragment: &shaders::LOBES_FRAG_CELLS,
                    compute: &shaders::LOBES_COMP_CELLS,
                }
            } else {
                Screen {
                    fragment: &shaders::LOBES_FRAG,
                    compute: &shaders::LOBES_COMP,
                }
            };
            let mut all = tree.constants().to_vec();
            all.extend(lighting.lobe_constants());
            all.extend([
                ("CONVERGING", converging.into()),
                ("ALBEDO_IMAGE", lighting.has_albedo.into()),
                ("LIT", need.bounces.is_any().into()),
                ("OCCLUSION_DOWNSCALE", lighting.occlusion_downscale),
                ("MATERIAL_COLUMNS", MATERIAL_COLUMNS),
            ]);
            let depth = Depth::Surface(Format::D32_SFLOAT);
            Ok(Variant {
                pipeline: screen(context, name, shaders, &[FORMAT], depth, &all)?,
                has_cells,
            })
        };
        let image = |name| {
            let desc = ImageDesc::flat(name, FORMAT, size);
            Image::new(context, &desc.target_by(context.route()))
        };
        let single = || variant("lobes", lighting.ambient == Ambient::Cells, false);
        let converging = || variant("lobes: rays", need.bounces.is_any(), true);
        Ok(Self {
            single: need.is_single.then(single).transpose()?,
            converging: need.converges.then(converging).transpose()?,
            seed: need.seed,
            light: [image("light in lobes 0")?, image("light in lobes 1")?],
        })
    }

    /// Draws the light in the lobes of the surfaces in view, kcd/m². `ambient`: light of the sky and of the bounces, or occlusion, as the
    /// lighting reads it in single frames. `converging`: number of the frame, if it is one of those whose mean converges; 0 starts a new
    /// mean. `None` for frames of a kind that the settings exclude, and without lobes.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        (geometry, tree, cells): (&Geometry, &Tree, Option<&Cells>),
        (surfaces, ambient): (&Surfaces, &Image),
        light: &Light<'_>,
        view: &View,
        converging: Option<u32>,
    ) -> Option<&Image> {
        let variant = match converging {
            Some(_) => &self.converging,
            None => &self.single,
        };
        let Variant {
            pipeline,
            has_cells,
        } = variant.as_ref()?;
        let prefiltered = light.sky_prefiltered?;
        self.light.swap(0, 1);
        let [new, old] = &self.light;
        let pass = tree.bound_to(recorder.pass("lobes", pipeline));
        let pass = surfaces.sampled_by(pass, geometry.materials());
        let mut pass = pass
            .sample("sky_radiance", light.sky_radiance, Sampler::Linear)
            .sample("sky_prefiltered", prefiltered, Sampler::Linear)
            .sample("sky_irradiance", light.sky_irradiance, Sampler::Linear)
            .sample("ambient", ambient, Sampler::Nearest)
            .sample("previous", old, Sampler::Nearest)
            .uniform("view", &view.block());
        if let Some(cells) = cells.filter(|_| *has_cells) {
            pass = cells
                .bound_to(pass)
                .uniform("scene", &cells.block(view, light.daylight));
        }
        pass.push(&Push {
            origin: view.window.map_or(IVec2::ZERO, |w| w.origin.as_ivec2()),
            index: converging.unwrap_or(0),
            seed: self.seed,
        })
        .output("light", new, Load::Clear([0.0; 4]))
        .selected_by(&surfaces.depth)
        .fill();
        Some(new)
    }
}
