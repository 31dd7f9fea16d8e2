//! The G-buffer: normal, diffuse reflectance, material and depth of the nearest surface. Positions follow from depth.

use std::sync::Arc;

use glam::Vec3;

use crate::gpu::{
    Context, Depth, Format, Image, ImageDesc, Load, Pass, Pipeline, PipelineDesc, Recorder, Result,
    Sampler, Shader, shaders,
};
use crate::gpu_struct;

use crate::passes::surfaces::culling::Cull;
use crate::passes::surfaces::details::Details;
use crate::passes::surfaces::geometry::{Bound, Geometry};
use crate::passes::view::View;

gpu_struct! {
    /// Camera and material of a draw.
    pub struct Push: push of
        GBUFFER_VERT, GBUFFER_FRAG, GBUFFER_LEAN_VERT, GBUFFER_LEAN_FRAG, GBUFFER_DETAILED_VERT, GBUFFER_DETAILED_FRAG
    {
        clip_from_world: [[f32; 4]; 4],
        eye: Vec3,
        diffuse: Vec3,
        material: u32,
        cutoff: f32,
        normal_scale: f32,
        mirrors: u32,
        sharpen: f32,
    }
}

impl Push {
    /// The camera and what a draw binds.
    pub(in crate::passes) fn of(
        clip_from_world: [[f32; 4]; 4],
        eye: Vec3,
        sharpen: f32,
        bound: &Bound<'_>,
    ) -> Self {
        Self {
            clip_from_world,
            eye,
            diffuse: bound.diffuse,
            material: bound.material,
            cutoff: bound.cutoff,
            normal_scale: bound.normal_scale,
            mirrors: bound.mirrors.into(),
            sharpen,
        }
    }
}

/// The images.
pub struct Surfaces {
    /// Words of each pixel: the world normal on the viewer's side (octahedral, 16 bits a component); number of the material
    /// (lower half), and how thick the body is behind the surface (upper half: that of a float's bits, metres). Of frames that
    /// converge a third has the slopes of the face, see `include/face_slope.glsl`, and a fourth fills up the texel.
    pub words: Image,
    /// ρ_d, and a factor on ρ_s; none of a scene without maps, whose table of materials has them.
    pub albedo: Option<Image>,
    /// Reversed depth: near / distance; 0 is background.
    pub depth: Image,
}

impl Surfaces {
    /// All of them.
    pub fn images(&self) -> impl Iterator<Item = &Image> {
        [&self.words, &self.depth].into_iter().chain(&self.albedo)
    }

    /// The colour attachments of a pass that draws them.
    pub(in crate::passes) fn colors<'r>(&'r self, pass: Pass<'r>, load: Load) -> Pass<'r> {
        let images = std::iter::once(&self.words).chain(&self.albedo);
        images.fold(pass, |pass, image| pass.color(image, load))
    }
}

/// Twin of `normal_unpack`: the halves of the first of [`Surfaces::words`] as a unit vector.
pub fn unpack_normal(halves: [u16; 2]) -> [f32; 3] {
    decode_normal(halves.map(|half| (f32::from(half.cast_signed()) / 32767.0).max(-1.0)))
}

/// Twin of `octahedral_decode`.
fn decode_normal([x, y]: [f32; 2]) -> [f32; 3] {
    let z = 1.0 - x.abs() - y.abs();
    let folded = |a: f32, b: f32| {
        if z < 0.0 {
            (1.0 - b.abs()) * 1f32.copysign(a)
        } else {
            a
        }
    };
    Vec3::new(folded(x, y), folded(y, x), z)
        .normalize_or(Vec3::Y)
        .to_array()
}

/// The pass and its images.
pub struct Gbuffer {
    /// For most surfaces.
    lean: Pipeline,
    /// By whether ρ_d and ρ_s have maps: a lookup that is not needed costs as much as one that is.
    pipelines: [[Pipeline; 2]; 2],
    details: Details,
    surfaces: Surfaces,
}

/// Position, normal with thickness, texture coordinates.
pub(in crate::passes) const VERTEX: [Format; 3] = [
    Format::R32G32B32_SFLOAT,
    Format::R32G32B32A32_SFLOAT,
    Format::R32G32_SFLOAT,
];

/// A pipeline that draws surfaces to colour targets of these formats.
pub(in crate::passes) fn surface_pipeline(
    context: &Arc<Context>,
    name: &str,
    stages: [&'static Shader; 2],
    vertex: &[Format],
    formats: &[Format],
    constants: &[(&str, u32)],
) -> Result<Pipeline> {
    Pipeline::new(
        context,
        &PipelineDesc {
            name,
            stages: &stages,
            vertex,
            colors: formats,
            depth: Depth::Write {
                format: Format::D32_SFLOAT,
                slope_bias: 0.0,
            },
            constants,
        },
    )
}

impl Gbuffer {
    /// Images of `size` pixels, and what drawing `geometry` takes; `faces`: with the slopes of the face under each pixel.
    ///
    /// # Errors
    /// When the device refuses.
    pub fn new(
        context: &Arc<Context>,
        geometry: &Geometry,
        size: [u32; 2],
        faces: bool,
    ) -> Result<Self> {
        let words = if faces {
            Format::R32G32B32A32_UINT
        } else {
            Format::R32G32_UINT
        };
        // One target of several words: a software device pays for each target more than for what is written.
        let mut formats = vec![words];
        if geometry.has_albedo() {
            formats.push(Format::R16G16B16A16_SFLOAT);
        }
        let pipelines = [(false, false), (false, true), (true, false), (true, true)].map(
            |(diffuse, specular)| {
                let constants = [
                    ("DIFFUSE_MAP", u32::from(diffuse)),
                    ("SPECULAR_MAP", u32::from(specular)),
                    ("FACES", u32::from(faces)),
                ];
                let stages = [&shaders::GBUFFER_VERT, &shaders::GBUFFER_FRAG];
                surface_pipeline(context, "G-buffer", stages, &VERTEX, &formats, &constants)
            },
        );
        let [plain, specular, diffuse, both] = pipelines;
        let pipelines = [[plain?, specular?], [diffuse?, both?]];
        let image = |name, format| Image::new(context, &ImageDesc::flat(name, format, size));
        let surfaces = Surfaces {
            words: image("words", formats[0])?,
            albedo: formats.get(1).map(|f| image("albedo", *f)).transpose()?,
            depth: image("depth", Format::D32_SFLOAT)?,
        };
        Ok(Self {
            lean: surface_pipeline(
                context,
                "G-buffer, lean",
                [&shaders::GBUFFER_LEAN_VERT, &shaders::GBUFFER_LEAN_FRAG],
                &VERTEX[..2],
                &formats,
                &[("FACES", u32::from(faces))],
            )?,
            pipelines,
            details: Details::new(context, geometry, &formats, faces)?,
            surfaces,
        })
    }

    /// The images as they were last drawn.
    pub fn surfaces(&self) -> &Surfaces {
        &self.surfaces
    }

    /// Draws the scene.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        geometry: &Geometry,
        view: &View,
    ) -> &Surfaces {
        let clip_from_world = view.clip_from_world().to_cols_array_2d();
        let clear = Load::Clear([0.0; 4]);
        let cull = Cull::camera(view);
        let pass = recorder.pass("G-buffer", &self.lean);
        self.surfaces
            .colors(pass, clear)
            .depth(&self.surfaces.depth, clear)
            .draws(|draws| {
                geometry.draw_lean(draws, &cull, |draws, bound| {
                    let (eye, sharpen) = (view.camera.eye, view.sharpen);
                    draws.push(&Push::of(clip_from_world, eye, sharpen, bound));
                });
            });
        if geometry.has_plain() {
            self.record_plain(recorder, geometry, view, &cull);
        }
        self.details
            .record(recorder, geometry, &self.surfaces, view, &cull);
        &self.surfaces
    }

    /// Draws what has maps, or normals that do not say which side is the front.
    fn record_plain(&self, recorder: &mut Recorder, geometry: &Geometry, view: &View, cull: &Cull) {
        let clip_from_world = view.clip_from_world().to_cols_array_2d();
        let pass = recorder.pass("G-buffer", &self.pipelines[0][0]);
        self.surfaces
            .colors(pass, Load::Keep)
            .depth(&self.surfaces.depth, Load::Keep)
            .draws(|draws| {
                let (eye, mut variant) = (view.camera.eye, [0, 0]);
                geometry.draw_plain(draws, cull, |draws, bound| {
                    let maps = [bound.diffuse_map, bound.specular_map];
                    let wanted = maps.map(|m| usize::from(m.is_some()));
                    if wanted != variant {
                        variant = wanted;
                        draws.pipeline(&self.pipelines[variant[0]][variant[1]]);
                    }
                    let [diffuse_map, specular_map] = maps.map(|m| m.unwrap_or(bound.white));
                    draws.texture("diffuse_map", diffuse_map, Sampler::Repeat);
                    draws.texture("specular_map", specular_map, Sampler::Repeat);
                    draws.push(&Push::of(clip_from_world, eye, view.sharpen, bound));
                });
            });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_come_back() {
        // The six axes and the middle of an upper and a lower octant.
        let third = 3f32.sqrt().recip();
        for (texel, normal) in [
            ([1.0, 0.0], [1.0, 0.0, 0.0]),
            ([0.0, -1.0], [0.0, -1.0, 0.0]),
            ([0.0, 0.0], [0.0, 0.0, 1.0]),
            ([1.0, 1.0], [0.0, 0.0, -1.0]),
            ([1.0 / 3.0, 1.0 / 3.0], [third, third, third]),
            ([2.0 / 3.0, -2.0 / 3.0], [third, -third, -third]),
        ] {
            let decoded = Vec3::from_array(decode_normal(texel));
            let error = (decoded - Vec3::from_array(normal)).length();
            assert!(error < 1e-6, "{texel:?}: {decoded}");
        }
    }
}
