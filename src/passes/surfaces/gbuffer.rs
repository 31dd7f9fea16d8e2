//! The G-buffer: normal, diffuse reflectance, material and depth of the nearest surface. Positions are reconstructed from depth.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::Vec3;

use crate::gpu::{
    Blend, Context, Depth, Draws, Format, Image, ImageDesc, Load, Pass, Pipeline, PipelineDesc,
    Recorder, Result, Sampler, Shader, shaders,
};
use crate::gpu_struct;

use crate::passes::surfaces::culling::Cull;
use crate::passes::surfaces::facts::Facts;
use crate::passes::surfaces::geometry::{Bound, EmissionSource, Geometry, Kind};
use crate::passes::surfaces::triangles::Triangles;
use crate::passes::view::View;

gpu_struct! {
    /// Uniforms shared by all draws.
    pub struct CameraBlock: camera of
        GBUFFER_VERT, GBUFFER_VERT_DETAILED, GBUFFER_FRAG, GBUFFER_FRAG_ALBEDO, GBUFFER_FRAG_ALBEDO_EMISSION,
        GBUFFER_FRAG_DETAILED, GBUFFER_FRAG_DETAILED_ALBEDO, GBUFFER_FRAG_DETAILED_ALBEDO_EMISSION
    {
        clip_from_world: [[f32; 4]; 4],
        eye: Vec3,
        sharpen: f32,
    }
}

gpu_struct! {
    /// Material of a draw call.
    pub struct Push: push of
        GBUFFER_FRAG, GBUFFER_FRAG_ALBEDO, GBUFFER_FRAG_ALBEDO_EMISSION,
        GBUFFER_FRAG_DETAILED, GBUFFER_FRAG_DETAILED_ALBEDO, GBUFFER_FRAG_DETAILED_ALBEDO_EMISSION
    {
        diffuse: Vec3,
        material: u32,
        cutoff: f32,
        normal_scale: f32,
        is_specular: u32,
        metallic: f32,
    }
}

impl Push {
    fn of(bound: &Bound<'_>) -> Self {
        Self {
            diffuse: bound.diffuse,
            material: bound.material,
            cutoff: bound.cutoff,
            normal_scale: bound.normal_scale,
            is_specular: bound.is_specular.into(),
            metallic: bound.metallic.unwrap_or(-1.0),
        }
    }
}

/// The images of the G-buffer.
pub struct Surfaces {
    /// First word: the world normal on the viewer's side (octahedral encoding, 16 bits per component). Second word: the number of
    /// the material in 24 bits, and how far a map lowers its roughness. Frames that trace rays from faces, as converging frames have a third word, the slopes of the face, see `include/face.glsl`, and a fourth as
    /// padding.
    pub normal_material: Image,
    /// ρ_d, and a factor on ρ_s, or base colour and metalness; `None` for a scene without maps, where the table of materials has ρ_d.
    pub albedo: Option<Image>,
    /// Factor on L_e of the table of materials; `None` for a scene without emissive textures.
    pub emission: Option<Image>,
    /// Reversed depth: near / distance; 0 is background.
    pub depth: Image,
}

fn depth_image(context: &Arc<Context>, size: [u32; 2]) -> Result<Image> {
    Image::new(context, &ImageDesc::flat("depth", Format::D32_SFLOAT, size))
}

impl Surfaces {
    fn new(
        context: &Arc<Context>,
        size: [u32; 2],
        targets: &[Format],
        is_stored: bool,
    ) -> Result<Self> {
        let image = |name, format| {
            let desc = ImageDesc::flat(name, format, size);
            Image::new(context, &if is_stored { desc.stored() } else { desc })
        };
        let target = |i: usize, name| {
            let format = targets.get(i);
            format.map(|format| image(name, *format)).transpose()
        };
        Ok(Self {
            normal_material: image("normal and material", targets[0])?,
            albedo: target(1, "albedo")?,
            emission: target(2, "emission")?,
            depth: depth_image(context, size)?,
        })
    }

    /// All images.
    pub fn images(&self) -> impl Iterator<Item = &Image> {
        [&self.normal_material, &self.depth]
            .into_iter()
            .chain(&self.albedo)
            .chain(&self.emission)
    }

    /// Samples the images and the table of materials in a pass, texel by texel.
    ///
    /// Without an albedo image the pipeline reads none, but the binding must be written: the table takes its place.
    pub fn sampled_by<'r>(&'r self, pass: Pass<'r>, materials: &'r Image) -> Pass<'r> {
        let albedo = self.albedo.as_ref().unwrap_or(materials);
        self.shapes_sampled_by(pass)
            .sample("albedo", albedo, Sampler::Nearest)
            .sample("materials", materials, Sampler::Nearest)
    }

    /// The factor on L_e, or where there is none any image that can take its place.
    pub fn emission_or<'r>(&'r self, other: &'r Image) -> &'r Image {
        self.emission.as_ref().unwrap_or(other)
    }

    /// Samples depth and normals in a pass, texel by texel.
    pub fn shapes_sampled_by<'r>(&'r self, pass: Pass<'r>) -> Pass<'r> {
        pass.sample("depth", &self.depth, Sampler::Nearest).sample(
            "normal_material",
            &self.normal_material,
            Sampler::Nearest,
        )
    }

    /// Adds the images but depth as those that a compute pass writes.
    pub(super) fn stored_by<'r>(&'r self, pass: Pass<'r>) -> Pass<'r> {
        let targets = [
            ("normal_material", Some(&self.normal_material)),
            ("albedo", self.albedo.as_ref()),
            ("emission", self.emission.as_ref()),
        ];
        let images = targets
            .into_iter()
            .filter_map(|(name, image)| Some((name, image?)));
        images.fold(pass, |pass, (name, image)| pass.store(name, image))
    }

    /// Adds the images as attachments of a pass.
    fn attach<'r>(&'r self, pass: Pass<'r>, load: Load) -> Pass<'r> {
        let images = std::iter::once(&self.normal_material).chain(&self.albedo);
        images
            .chain(&self.emission)
            .fold(pass, |pass, image| pass.color(image, load))
            .depth(&self.depth, load)
    }
}

/// CPU counterpart of `normal_unpack`: decodes the halves of the first word of [`Surfaces::normal_material`] to a unit vector.
pub fn unpack_normal(halves: [u16; 2]) -> [f32; 3] {
    decode_normal(halves.map(|half| (f32::from(half.cast_signed()) / 32767.0).max(-1.0)))
}

/// CPU counterpart of `octahedral_decode`.
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

/// Formats of the G-buffer's render targets, and whether they store face slopes.
struct Targets {
    formats: Vec<Format>,
    faces: bool,
}

/// The G-buffer pass and its images.
pub struct Gbuffer {
    /// Surfaces without maps, where their triangles are numbered.
    triangles: Option<Triangles>,
    /// For surfaces without maps whose normals match their winding, the most common case.
    untextured: Pipeline,
    /// For other surfaces that are not detailed, by kind.
    textured: BTreeMap<Kind, Pipeline>,
    /// For surfaces with alpha test, normal maps or vertex colours, by kind.
    detailed: BTreeMap<Kind, Pipeline>,
    surfaces: Surfaces,
    /// Depth of the frame before, if it is kept.
    depth_before: Option<Image>,
}

/// Position, normal, texture coordinates; for detailed surfaces also colour and tangent.
const VERTEX: [Format; 5] = [
    Format::R32G32B32_SFLOAT,
    Format::R32G32B32_SFLOAT,
    Format::R32G32_SFLOAT,
    Format::R16G16B16A16_UNORM,
    Format::R16G16B16A16_SNORM,
];

/// The shader stages for a kind of surface and a number of targets, and the number of its vertex streams.
fn stages(kind: Kind, targets: usize) -> ([&'static Shader; 2], usize) {
    let is_detailed = kind.is_detailed();
    let fragment = match (is_detailed, targets) {
        (false, 1) => &shaders::GBUFFER_FRAG,
        (false, 2) => &shaders::GBUFFER_FRAG_ALBEDO,
        (false, _) => &shaders::GBUFFER_FRAG_ALBEDO_EMISSION,
        (true, 1) => &shaders::GBUFFER_FRAG_DETAILED,
        (true, 2) => &shaders::GBUFFER_FRAG_DETAILED_ALBEDO,
        (true, _) => &shaders::GBUFFER_FRAG_DETAILED_ALBEDO_EMISSION,
    };
    if is_detailed {
        ([&shaders::GBUFFER_VERT_DETAILED, fragment], 5)
    } else {
        ([&shaders::GBUFFER_VERT, fragment], 3)
    }
}

impl Targets {
    /// Creates a pipeline for a kind of surface.
    fn pipeline(
        &self,
        context: &Arc<Context>,
        kind: Kind,
        normals_match_winding: bool,
    ) -> Result<Pipeline> {
        let (stages, streams) = stages(kind, self.formats.len());
        let mut constants = vec![
            ("DIFFUSE_MAP", kind.diffuse_map.into()),
            ("SPECULAR_MAP", kind.specular_map.into()),
            ("CUT_OUT", kind.cut_out.into()),
            ("NORMALS_MATCH_WINDING", normals_match_winding.into()),
            ("FACES", self.faces.into()),
        ];
        if kind.is_detailed() {
            constants.push(("NORMAL_MAP", kind.normal_map.into()));
        }
        if self.formats.len() > 2 {
            constants.push(("EMISSIVE_MAP", kind.emissive_map.into()));
        }
        Pipeline::new(
            context,
            &PipelineDesc {
                name: "G-buffer",
                stages: &stages,
                vertex: &VERTEX[..streams],
                colors: &self.formats,
                depth: Depth::Write(Format::D32_SFLOAT),
                blend: Blend::Off,
                constants: &constants,
            },
        )
    }
}

impl Gbuffer {
    /// Creates images of `size` pixels and the pipelines that the scene needs. `faces`: store the slopes of the face at each pixel. `keeps`: keep
    /// the depth of the frame before.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(
        context: &Arc<Context>,
        facts: &Facts,
        size: [u32; 2],
        (faces, keeps): (bool, bool),
    ) -> Result<Self> {
        // One target of several words: on a software device the number of targets costs more than the amount written.
        // Compute shaders store the wider format on every device.
        let mut formats = vec![if faces || facts.is_numbered {
            Format::R32G32B32A32_UINT
        } else {
            Format::R32G32_UINT
        }];
        if facts.has_albedo() {
            formats.push(Format::R16G16B16A16_SFLOAT);
        }
        if facts.emission_source == EmissionSource::Image {
            formats.push(Format::R16G16B16A16_SFLOAT);
        }
        let targets = Targets { formats, faces };
        let pipelines = |is_detailed: bool| {
            let kinds = facts.kinds.iter();
            let kinds = kinds.filter(move |k| k.is_detailed() == is_detailed);
            kinds.map(|kind| Ok((*kind, targets.pipeline(context, *kind, false)?)))
        };
        Ok(Self {
            untextured: targets.pipeline(context, Kind::default(), true)?,
            textured: pipelines(false).collect::<Result<_>>()?,
            detailed: pipelines(true).collect::<Result<_>>()?,
            triangles: facts
                .is_numbered
                .then(|| Triangles::new(context, size, targets.formats.len(), faces))
                .transpose()?,
            surfaces: Surfaces::new(context, size, &targets.formats, facts.is_numbered)?,
            depth_before: keeps.then(|| depth_image(context, size)).transpose()?,
        })
    }

    /// Keeps the depth as last drawn for the next frame, if it is kept at all.
    pub fn turn(&mut self) {
        if let Some(before) = &mut self.depth_before {
            std::mem::swap(&mut self.surfaces.depth, before);
        }
    }

    /// Depth before the last [`Gbuffer::turn`], if it is kept.
    pub fn depth_before(&self) -> Option<&Image> {
        self.depth_before.as_ref()
    }

    /// The images that are drawn first.
    pub fn targets(&self) -> impl Iterator<Item = &Image> {
        let (numbers, surfaces) = match &self.triangles {
            Some(triangles) => (Some([triangles.target(), &self.surfaces.depth]), None),
            None => (None, Some(self.surfaces.images())),
        };
        numbers
            .into_iter()
            .flatten()
            .chain(surfaces.into_iter().flatten())
    }

    /// The images as last drawn.
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
        let cull = Cull::camera(view);
        let camera = CameraBlock {
            clip_from_world: view.clip_from_world().to_cols_array_2d(),
            eye: view.camera.eye,
            sharpen: view.sharpen,
        };
        let has_emission = self.surfaces.emission.is_some();
        let bind = |draws: &mut Draws<'_, '_>, bound: &Bound<'_>| bind(draws, bound, has_emission);
        match &self.triangles {
            None => {
                let pass = recorder.pass("G-buffer", &self.untextured);
                let pass = pass.uniform("camera", &camera);
                self.surfaces
                    .attach(pass, Load::Clear([0.0; 4]))
                    .draws(|draws| {
                        geometry.draw_untextured(draws, &cull, bind);
                        self.draw_textured(draws, geometry, &cull, bind);
                    });
            }
            Some(triangles) => {
                triangles.record(recorder, geometry, view, &self.surfaces);
                if self.textured.keys().any(|kind| *kind != Kind::default()) {
                    let pass = recorder.pass("G-buffer, maps", &self.untextured);
                    let pass = pass.uniform("camera", &camera);
                    self.surfaces
                        .attach(pass, Load::Keep)
                        .draws(|draws| self.draw_textured(draws, geometry, &cull, bind));
                }
            }
        }
        if let Some((_, first)) = self.detailed.first_key_value() {
            let pass = recorder.pass("G-buffer, details", first);
            self.surfaces
                .attach(pass.uniform("camera", &camera), Load::Keep)
                .draws(|draws| {
                    let mut current = None;
                    geometry.draw_detailed(draws, &cull, |draws, bound| {
                        switch(draws, &self.detailed, &mut current, bound.kind);
                        let normal_map = bound.normal_map.unwrap_or(bound.white);
                        draws.texture("normal_map", normal_map.image, normal_map.sampler);
                        bind(draws, bound);
                    });
                });
        }
        &self.surfaces
    }

    /// Draws surfaces with maps that are not detailed, and what else the first pass has left.
    fn draw_textured<'r>(
        &'r self,
        draws: &mut Draws<'_, 'r>,
        geometry: &Geometry,
        cull: &Cull,
        bind: impl Fn(&mut Draws<'_, '_>, &Bound<'_>),
    ) {
        let mut current = None;
        geometry.draw_textured(draws, cull, |draws, bound| {
            switch(draws, &self.textured, &mut current, bound.kind);
            bind(draws, bound);
        });
    }
}

/// Binds the pipeline of a kind, if it is not the current one.
fn switch<'r>(
    draws: &mut Draws<'_, 'r>,
    pipelines: &'r BTreeMap<Kind, Pipeline>,
    current: &mut Option<Kind>,
    kind: Kind,
) {
    if current.replace(kind) != Some(kind) {
        draws.pipeline(&pipelines[&kind]);
    }
}

/// Binds the maps of ρ_d, ρ_s and, if pipelines read them, L_e of a draw, and pushes its material.
fn bind(draws: &mut Draws<'_, '_>, bound: &Bound<'_>, has_emission: bool) {
    let maps = [bound.diffuse_map, bound.specular_map];
    let [diffuse_map, specular_map] = maps.map(|map| map.unwrap_or(bound.white));
    draws.texture("diffuse_map", diffuse_map.image, diffuse_map.sampler);
    draws.texture("specular_map", specular_map.image, specular_map.sampler);
    if has_emission {
        let map = bound.emissive_map.unwrap_or(bound.white);
        draws.texture("emissive_map", map.image, map.sampler);
    }
    draws.push(&Push::of(bound));
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

    #[test]
    fn fragments_write_the_targets_that_there_are() {
        for kind in [
            Kind::default(),
            Kind {
                normal_map: true,
                ..Kind::default()
            },
        ] {
            for targets in 1..=3 {
                let ([_, fragment], _) = stages(kind, targets);
                assert_eq!(fragment.outputs, targets, "{}", fragment.name);
            }
        }
    }
}
