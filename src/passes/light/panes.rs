//! Panes of clear glass before the picture: what they let through, and what they mirror. The panes of a pixel are not sorted: the
//! transmittances of all before the surface are multiplied, and what each mirrors is added undimmed by those before it.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use crate::gpu::{
    Blend, Context, Depth, Format, Image, ImageDesc, Load, Pass, Pipeline, PipelineDesc, Recorder,
    Result, Sampler, Shader, shaders,
};
use crate::gpu_struct;

use crate::passes::bounces::tree::{Tree, TreeFacts};
use crate::passes::surfaces::culling::Cull;
use crate::passes::surfaces::geometry::Geometry;
use crate::passes::view::View;
use crate::passes::{glass_index, kilo};

gpu_struct! {
    /// The camera.
    pub struct PaneCamera: camera of PANE_VERT, PANE_THROUGH_FRAG, PANE_MIRROR_FRAG {
        clip_from_world: [[f32; 4]; 4],
        eye: Vec3,
    }
}

gpu_struct! {
    /// The glass of a draw, and the factor on what it mirrors.
    pub struct Push: push of PANE_VERT, PANE_THROUGH_FRAG, PANE_MIRROR_FRAG {
        internal: Vec3,
        scale: f32,
    }
}

gpu_struct! {
    /// The directional light of mirrored surfaces.
    pub struct MirroredSun: sun of PANE_MIRROR_FRAG {
        direction: Vec3,
        illuminance: Vec3,
    }
}

/// Position and normal.
const VERTEX: [Format; 2] = [Format::R32G32B32_SFLOAT; 2];

/// Half floats: they can be combined on every device, and what is mirrored is a small part of the sky.
const FORMAT: Format = Format::R16G16B16A16_SFLOAT;

/// What panes mirror.
#[derive(Clone, Copy)]
pub struct Surroundings<'a> {
    /// Unit vector toward the point of the sun's disc that this frame samples.
    pub sun_direction: Vec3,
    /// Illuminance of the directional light at normal incidence, linear BT.709 RGB, lux.
    pub sun_illuminance: DVec3,
    /// Irradiance E of sky and ground, klx.
    pub sky_irradiance: &'a Image,
    /// Radiance L of sky and ground, kcd/m².
    pub sky_radiance: &'a Image,
}

/// The passes that draw panes, and their images.
pub struct Panes {
    through: Pipeline,
    mirror: Pipeline,
    /// Transmittance, linear RGB; 1 where there is no pane.
    transmittance: Image,
    /// Mirrored radiance, kcd/m²; 0 where there is no pane.
    mirrored: Image,
    scale: f32,
}

impl Panes {
    /// Creates the passes for pictures of `size` pixels. `scale`: factor on what panes mirror.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(
        context: &Arc<Context>,
        tree: &TreeFacts,
        size: [u32; 2],
        scale: f32,
    ) -> Result<Self> {
        let image = |name| Image::new(context, &ImageDesc::flat(name, FORMAT, size));
        let pipeline = |name, fragment: &'static Shader, blend, constants: &[(&str, u32)]| {
            Pipeline::new(
                context,
                &PipelineDesc {
                    name,
                    stages: &[&shaders::PANE_VERT, fragment],
                    vertex: &VERTEX,
                    colors: &[FORMAT],
                    depth: Depth::Test(Format::D32_SFLOAT),
                    blend,
                    constants,
                },
            )
        };
        let (through, mirror) = (&shaders::PANE_THROUGH_FRAG, &shaders::PANE_MIRROR_FRAG);
        Ok(Self {
            through: pipeline("panes: through", through, Blend::Multiply, &[glass_index()])?,
            mirror: pipeline("panes: mirrored", mirror, Blend::Add, &tree.constants())?,
            transmittance: image("panes: transmittance")?,
            mirrored: image("panes: mirrored")?,
            scale,
        })
    }

    /// Draws the panes before the surfaces of `depth`.
    pub fn record(
        &self,
        recorder: &mut Recorder,
        (geometry, tree): (&Geometry, &Tree),
        depth: &Image,
        around: &Surroundings<'_>,
        view: &View,
    ) {
        let cull = Cull::camera(view);
        let camera = PaneCamera {
            clip_from_world: view.clip_from_world().to_cols_array_2d(),
            eye: view.camera.eye,
        };
        let draw = |pass: Pass<'_>| {
            pass.depth_test(depth).draws(|draws| {
                geometry.draw_panes(draws, &cull, |draws, internal| {
                    draws.push(&Push {
                        internal,
                        scale: self.scale,
                    });
                });
            });
        };
        let pass = recorder.pass("panes: through", &self.through);
        draw(
            pass.uniform("camera", &camera)
                .color(&self.transmittance, Load::Clear([1.0; 4])),
        );
        let pass = recorder.pass("panes: mirrored", &self.mirror);
        let pass = tree
            .bound_to(pass)
            .uniform("camera", &camera)
            .uniform(
                "sun",
                &MirroredSun {
                    direction: around.sun_direction,
                    illuminance: kilo(around.sun_illuminance),
                },
            )
            .sample("sky_radiance", around.sky_radiance, Sampler::Linear)
            .sample("sky_irradiance", around.sky_irradiance, Sampler::Linear)
            .color(&self.mirrored, Load::Clear([0.0; 4]));
        draw(pass);
    }
}

/// The images of the panes of a frame, if there are any.
#[derive(Clone, Copy)]
pub struct BeforePicture<'a>(pub Option<&'a Panes>);

impl<'a> BeforePicture<'a> {
    /// Samples the images in a pass with `include/panes.glsl`. Without panes the pipeline reads none, but the bindings must be written:
    /// `other` takes their place.
    pub fn sampled_by<'r>(self, pass: Pass<'r>, other: &'r Image) -> Pass<'r>
    where
        'a: 'r,
    {
        let (transmittance, mirrored) = self.0.map_or((other, other), |panes| {
            (&panes.transmittance, &panes.mirrored)
        });
        pass.sample("panes_transmittance", transmittance, Sampler::Nearest)
            .sample("panes_mirrored", mirrored, Sampler::Nearest)
    }
}
