//! Sky light with true visibility from sampled sky directions, averaged over many frames.
//!
//! [`SkySampler`] importance samples a few directions per frame by luminance. For each one, the frame draws a depth map into a
//! tile of one image or traces a ray from each pixel, see [`crate::passes::dome::route`]. Per pixel it sums V L cos θ / p over these directions (N), and the same without V (D). The means over the
//! frames converge to ∫ V L cos dω and to the unoccluded E, which the irradiance cube has without noise (U). The picture shows
//! N · U / D: exact from the first frame on where the sky is unoccluded; elsewhere errors of N and D partly cancel. U / D tends
//! to 1, so no bias remains.
//!
//! The ground below the horizon is a light source too: directions of the lower hemisphere are among them.

use std::sync::Arc;

use glam::{IVec2, Vec3};

use crate::daylight::sampling;
use crate::daylight::sky::Daylight;
use crate::daylight::sky_sampler::{DomeLight, SkySampler, ground_light};
use crate::gpu::{
    Context, Depth, Format, Image, ImageDesc, Load, Pipeline, Recorder, Result, Sampler, shaders,
};
use crate::gpu_struct;

use crate::passes::bounces::cells::Bounces;
use crate::passes::bounces::gather::HalfSize;
use crate::passes::bounces::tree::{Tree, TreeFacts};
use crate::passes::dome::maps::DomeMaps;
use crate::passes::dome::rays::SkyRays;
use crate::passes::dome::route::DomeBy;
use crate::passes::dome::specular::SpecularSky;
use crate::passes::light::lighting::{LightingSettings, Show};
use crate::passes::light::panes::BeforePicture;
use crate::passes::sky::air::AirBefore;
use crate::passes::sun_shadow::fit::ShadowView;
use crate::passes::sun_shadow::perspective::{Receivers, fit};
use crate::passes::surfaces::facts::Facts;
use crate::passes::surfaces::gbuffer::Surfaces;
use crate::passes::surfaces::geometry::Geometry;
use crate::passes::surfaces::upload::MATERIAL_COLUMNS;
use crate::passes::view::View;
use crate::passes::{Screen, kilo, screen};

/// Largest number of directions per frame: the length of the shader's arrays.
pub const MOST_DIRECTIONS: u32 = 16;

gpu_struct! {
    /// The directions of a frame, see `include/dome.glsl`.
    pub struct DomeBlock: dome of DOME_GATHER_FRAG, DOME_GATHER_COMP, DOME_SPECULAR_FRAG, DOME_SPECULAR_COMP {
        clip_from_world: [[[f32; 4]; 4]; 16],
        planes: [[[f32; 4]; 4]; 16],
        window: [[f32; 4]; 16],
        toward: [[f32; 4]; 16],
        light: [[f32; 4]; 16],
    }
}

gpu_struct! {
    /// Radiance of the ground, the weight of this frame, and its pixels with bounced light.
    pub struct Push: push of DOME_GATHER_FRAG, DOME_GATHER_COMP {
        ground: Vec3,
        share: f32,
        chosen: IVec2,
    }
}

/// A light direction with its shadow map, a tile of the atlas.
struct Direction<'a> {
    /// Unit vector toward the light.
    pub toward: Vec3,
    /// Its contribution to the irradiance at normal incidence, klx.
    pub light: Vec3,
    /// Whether it belongs to the sky rather than the ground.
    pub is_sky: bool,
    /// View of its map.
    pub view: &'a ShadowView,
    /// First texel of the map, and its edge.
    pub window: [u32; 3],
}

impl DomeBlock {
    /// Fills the block with at most [`MOST_DIRECTIONS`] directions.
    fn new<'a>(directions: impl Iterator<Item = Direction<'a>>) -> Self {
        let mut block: Self = bytemuck::Zeroable::zeroed();
        for (k, d) in directions.take(MOST_DIRECTIONS as usize).enumerate() {
            let [x, y, edge] = d.window;
            block.clip_from_world[k] = d.view.shadow_from_world.to_cols_array_2d();
            block.planes[k] = d.view.planes().to_cols_array_2d();
            block.window[k] = [x, y, edge, edge].map(|texels| texels as f32);
            block.toward[k] = d.toward.extend(BIAS_TEXELS * d.view.texel_depth).to_array();
            block.light[k] = d.light.extend(f32::from(u8::from(d.is_sky))).to_array();
        }
        block
    }
}

/// Settings of the dome: directions and shadow map resolution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DomeSettings {
    /// Directions per frame, 1..=16.
    pub directions: u32,
    /// Edge of a map, texels.
    pub map_edge: u32,
    /// How the visibility is found. [`crate::frame::Frame`] chooses between maps and rays.
    pub by: DomeBy,
    /// Seed of the sample sequences.
    pub seed: u32,
    /// Whether the picture's fourth channel holds the illuminance, klx, regardless of the quantity shown; for read-outs.
    pub illuminance: bool,
}

impl Default for DomeSettings {
    fn default() -> Self {
        Self {
            directions: 12,
            map_edge: 1024,
            by: DomeBy::default(),
            seed: 0,
            illuminance: false,
        }
    }
}

/// Inputs of the pass.
#[derive(Clone, Copy)]
pub struct Gathered<'a> {
    /// The surfaces in view.
    pub surfaces: &'a Surfaces,
    /// ρ_d of the materials.
    pub materials: &'a Image,
    /// The picture without sky light, kcd/m².
    pub frame: &'a Image,
    /// Irradiance E of sky and ground, klx.
    pub sky_irradiance: &'a Image,
    /// Radiance L of sky and ground, kcd/m².
    pub sky_radiance: &'a Image,
    /// Panes of glass before the picture.
    pub panes: BeforePicture<'a>,
    /// The air before the eye.
    pub air: AirBefore<'a>,
    /// Irradiance from other surfaces, klx; `None` without bounces.
    pub bounced: Option<HalfSize<'a>>,
}

/// Depth bias of the comparison, texels. Within half a texel of a concave edge, the texel's centre may lie on the other face, up to
/// about a texel above this one. Measured on the truth views: a bias of 0.2 loses 0.5 to 0.8 % of the light, 1 less than 0.2 %;
/// 1.5 leaks light at contacts.
pub(in crate::passes) const BIAS_TEXELS: f32 = 1.0;

/// The dome passes and their images.
pub struct Dome {
    settings: DomeSettings,
    gather: Pipeline,
    resolve: Pipeline,
    /// Maps of everything or, with rays, of cut-outs and panes of glass, if there are any.
    maps: Option<DomeMaps>,
    rays: Option<SkyRays>,
    /// Alternating means: sky light and other light, see `dome_gather.glsl`.
    means: [[Image; 2]; 2],
    /// Alternating means of the illuminance terms, if enabled.
    illuminance: Option<[Image; 2]>,
    radiance: Image,
    /// Specular reflection of the sky with visibility, if enabled.
    specular: Option<SpecularSky>,
    sky: Option<(Daylight, SkySampler)>,
    is_shown: bool,
}

/// Seed of the ground's directions, distinct from that of the sky's.
const GROUND: u32 = 0x0640_0000;

const FORMAT: Format = Format::R32G32B32A32_SFLOAT;

/// Whether the quantity shown includes sky light.
fn shows_sky(show: Show) -> bool {
    matches!(
        show,
        Show::Beauty | Show::Luminance | Show::Sky | Show::Irradiance | Show::Occlusion
    )
}

impl Dome {
    /// Creates the passes for pictures of `size` pixels.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(
        context: &Arc<Context>,
        (facts, tree): (&Facts, &TreeFacts),
        size: [u32; 2],
        settings: DomeSettings,
        lighting: LightingSettings,
        bounces: Bounces,
    ) -> Result<Self> {
        let show = lighting.show;
        let specular = SpecularSky::new(context, size, settings, lighting)?;
        let image = |name| {
            let desc = ImageDesc::flat(name, FORMAT, size);
            Image::new(context, &desc.target_by(context.route()))
        };
        let maps = DomeMaps::new(context, facts, settings)?;
        let (directions, has_maps) = (settings.directions, maps.is_some());
        let rays = (settings.by == DomeBy::Rays)
            .then(|| SkyRays::new(context, tree, size, directions, has_maps))
            .transpose()?;
        Ok(Self {
            settings,
            gather: gather_pipeline(context, facts, settings, lighting, bounces)?,
            resolve: screen(
                context,
                "dome: resolve",
                Screen {
                    fragment: &shaders::DOME_RESOLVE_FRAG,
                    compute: &shaders::DOME_RESOLVE_COMP,
                },
                &[FORMAT],
                Depth::Off,
                &[("ILLUMINANCE", settings.illuminance.into())],
            )?,
            maps,
            rays,
            means: [
                [image("sky mean 0")?, image("rest mean 0")?],
                [image("sky mean 1")?, image("rest mean 1")?],
            ],
            illuminance: settings
                .illuminance
                .then(|| Ok([image("illuminance mean 0")?, image("illuminance mean 1")?]))
                .transpose()?,
            radiance: image("radiance, converging")?,
            sky: None,
            is_shown: shows_sky(show) || specular.is_some() || settings.illuminance,
            specular,
        })
    }

    /// Finds the visibility in the directions of frame number `index` and adds its light to the means; 0 starts new means.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        (geometry, tree): (&Geometry, &Tree),
        gathered: &Gathered<'_>,
        daylight: &Daylight,
        view: &View,
        index: u32,
    ) -> &Image {
        let lights = self.lights(daylight, index);
        let receivers = Receivers::new(geometry.bounds(), view);
        let views: Vec<ShadowView> = (0u32..)
            .zip(&lights)
            .map(|(k, light)| {
                // Not from the sequence of the directions: otherwise a direction would always get the same shift.
                let number = index.wrapping_mul(self.settings.directions) + k;
                let shift = sampling::richtmyer(number).as_vec2();
                let toward = light.direction.as_vec3();
                fit(
                    toward,
                    geometry.bounds(),
                    &receivers,
                    self.settings.map_edge,
                    shift,
                )
            })
            .collect();
        let block = self.block(&lights, &views, daylight);
        let push = Push {
            ground: kilo(daylight.ground_luminance),
            share: 1.0 / (index + 1) as f32,
            chosen: gathered.bounced.map_or(IVec2::ZERO, |b| b.chosen),
        };
        if self.is_shown {
            if let Some(maps) = &self.maps {
                maps.record(recorder, geometry, &views);
            }
            if let Some(rays) = &self.rays {
                let scene = (tree, maps_or_any(&self.maps, gathered));
                rays.record(
                    recorder,
                    scene,
                    gathered.surfaces,
                    view,
                    &block,
                    push.ground,
                );
            }
        }
        self.gather(recorder, gathered, view, &block, &push);
        self.resolve(recorder);
        if let Some(specular) = &mut self.specular {
            let maps = maps_or_any(&self.maps, gathered);
            let (maps, picture) = ((maps, &block), &self.radiance);
            specular.record(recorder, gathered, view, maps, picture, index);
        }
        self.image()
    }

    /// The picture of the newest means, kcd/m².
    pub fn image(&self) -> &Image {
        self.specular
            .as_ref()
            .map_or(&self.radiance, SpecularSky::image)
    }

    /// Directions of the frame: first those of the sky, then, if the ground has luminance, a quarter for the ground. Each represents
    /// an equal share of its hemisphere's samples.
    fn lights(&mut self, daylight: &Daylight, index: u32) -> Vec<DomeLight> {
        if self.sky.as_ref().is_none_or(|(drawn, _)| drawn != daylight) {
            self.sky = Some((daylight.clone(), SkySampler::new(daylight)));
        }
        let Some((_, sky)) = &self.sky else {
            return Vec::new();
        };
        let (of_sky, of_ground) = self.counts(daylight);
        let seed = self.settings.seed;
        let point = |count: u32, k: u32, which: u32| {
            sampling::scrambled_sobol(index.wrapping_mul(count) + k, seed ^ which)
        };
        let above = (0..of_sky).map(|k| (sky.light(daylight, point(of_sky, k, 0)), of_sky));
        let below = (0..of_ground).map(|k| {
            (
                ground_light(daylight, point(of_ground, k, GROUND)),
                of_ground,
            )
        });
        above
            .chain(below)
            .map(|(light, count)| DomeLight {
                illuminance: light.illuminance / f64::from(count),
                ..light
            })
            .collect()
    }

    /// Numbers of sky and ground directions.
    fn counts(&self, daylight: &Daylight) -> (u32, u32) {
        let all = self.settings.directions;
        if daylight.ground_luminance.max_element() <= 0.0 || all == 1 {
            return (all, 0);
        }
        let of_ground = (all / 4).max(1);
        (all - of_ground, of_ground)
    }

    fn block(&self, lights: &[DomeLight], views: &[ShadowView], daylight: &Daylight) -> DomeBlock {
        let of_sky = self.counts(daylight).0 as usize;
        let directions = lights.iter().zip(views).enumerate();
        let window = |k| self.maps.as_ref().map_or([0; 3], |maps| maps.window(k));
        DomeBlock::new(directions.map(|(k, (light, view))| Direction {
            toward: light.direction.as_vec3(),
            light: kilo(light.illuminance),
            is_sky: k < of_sky,
            view,
            window: window(k),
        }))
    }

    fn gather(
        &mut self,
        recorder: &mut Recorder,
        gathered: &Gathered<'_>,
        view: &View,
        block: &DomeBlock,
        push: &Push,
    ) {
        self.means.swap(0, 1);
        let [[sky, rest], [old_sky, old_rest]] = &self.means;
        let surfaces = gathered.surfaces;
        // Without bounces any image will do: the binding must be written.
        let bounced = gathered
            .bounced
            .map_or(&surfaces.normal_material, |b| b.image);
        let sky_light = self.rays.as_ref().map_or(old_sky, SkyRays::light);
        let pass = recorder.pass("dome: gather", &self.gather);
        let pass = gathered.panes.sampled_by(pass, gathered.materials);
        let pass = surfaces.sampled_by(pass, gathered.materials);
        let pass = gathered
            .air
            .sampled_by(pass, gathered.materials)
            .sample("frame", gathered.frame, Sampler::Nearest)
            .sample("previous_sky", old_sky, Sampler::Nearest)
            .sample("previous_rest", old_rest, Sampler::Nearest)
            .sample("maps", maps_or_any(&self.maps, gathered), Sampler::Nearest)
            .sample("sky_light", sky_light, Sampler::Nearest)
            .sample("sky_irradiance", gathered.sky_irradiance, Sampler::Linear)
            .sample("bounced", bounced, Sampler::Nearest)
            .uniform("view", &view.block())
            .uniform("dome", block)
            .push(push)
            .output("new_sky", sky, Load::Discard)
            .output("new_rest", rest, Load::Discard);
        match &mut self.illuminance {
            Some(means) => {
                means.swap(0, 1);
                let [new, old] = means;
                pass.sample("previous_illuminance", old, Sampler::Nearest)
                    .output("new_illuminance", new, Load::Discard)
                    .fill();
            }
            None => pass.fill(),
        }
    }

    fn resolve(&self, recorder: &mut Recorder) {
        let [sky, rest] = &self.means[0];
        // Without illuminance any image will do: the binding must be written.
        let illuminance = self.illuminance.as_ref().map_or(rest, |means| &means[0]);
        recorder
            .pass("dome: resolve", &self.resolve)
            .sample("sky", sky, Sampler::Nearest)
            .sample("rest", rest, Sampler::Nearest)
            .sample("illuminance", illuminance, Sampler::Nearest)
            .output("radiance", &self.radiance, Load::Discard)
            .fill();
    }
}

/// The maps; without any another image, since the binding must be written.
fn maps_or_any<'a>(maps: &'a Option<DomeMaps>, gathered: &Gathered<'a>) -> &'a Image {
    let any = &gathered.surfaces.depth;
    maps.as_ref().map_or(any, DomeMaps::image)
}

fn gather_pipeline(
    context: &Arc<Context>,
    facts: &Facts,
    settings: DomeSettings,
    lighting: LightingSettings,
    bounces: Bounces,
) -> Result<Pipeline> {
    let show = lighting.show;
    // What is not light has no air before it.
    let air = lighting.air && !matches!(show, Show::Irradiance | Show::Occlusion);
    let (shaders, targets) = if settings.illuminance {
        let shaders = Screen {
            fragment: &shaders::DOME_GATHER_FRAG_ILLUMINANCE,
            compute: &shaders::DOME_GATHER_COMP_ILLUMINANCE,
        };
        (shaders, 3)
    } else {
        let shaders = Screen {
            fragment: &shaders::DOME_GATHER_FRAG,
            compute: &shaders::DOME_GATHER_COMP,
        };
        (shaders, 2)
    };
    let mut constants = lighting.lobe_constants().to_vec();
    constants.extend([
        ("SHOW_IRRADIANCE", (show == Show::Irradiance).into()),
        ("SHOW_OCCLUSION", (show == Show::Occlusion).into()),
        ("SKY", shows_sky(show).into()),
        ("DIRECTIONS", settings.directions),
        ("RAYS", (settings.by == DomeBy::Rays).into()),
        ("AIR", air.into()),
        ("ALBEDO_IMAGE", facts.has_albedo().into()),
        ("PANES", facts.has_panes.into()),
        ("BOUNCES", bounces.is_any().into()),
        (
            "SHOW_BOUNCES",
            (bounces.is_any() && show.has_bounces()).into(),
        ),
        ("MATERIAL_COLUMNS", MATERIAL_COLUMNS),
    ]);
    let formats = &[FORMAT; 3][..targets];
    screen(
        context,
        "dome: gather",
        shaders,
        formats,
        Depth::Off,
        &constants,
    )
}
