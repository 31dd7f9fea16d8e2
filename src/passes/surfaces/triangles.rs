//! The G-buffer of surfaces without maps in two steps: a rasteriser writes the number of the triangle at each pixel, and a compute shader what the
//! surface is like there. Burns & Hunt 2013, "The Visibility Buffer".
//!
//! It is for devices that compute faster than they shade fragments ([`Route::Compute`]): there a fragment should do no more than it must.

use std::sync::Arc;

use crate::gpu::{
    Blend, Buffer, BufferKind, Context, Depth, Format, Image, ImageDesc, Load, Optional, Pipeline,
    PipelineDesc, Recorder, Result, Route, Sampler, Shader, shaders, upload_buffer,
};
use crate::gpu_struct;

use crate::passes::compute;
use crate::passes::surfaces::culling::Cull;
use crate::passes::surfaces::gbuffer::Surfaces;
use crate::passes::surfaces::geometry::{Geometry, Kind, Part};
use crate::passes::surfaces::upload::MATERIAL_COLUMNS;
use crate::passes::view::View;
use crate::scene::Cluster;

gpu_struct! {
    /// The camera, and the first triangle of a draw.
    pub struct Push: push of TRIANGLES_VERT, TRIANGLES_FRAG {
        clip_from_world: [[f32; 4]; 4],
        first: u32,
    }
}

/// Format of the numbers of triangles.
const NUMBER: Format = Format::R32_UINT;

/// Whether a device draws surfaces without maps like this. `bytes`: size of the largest buffer of the geometry.
fn are_numbered(context: &Context, bytes: usize) -> bool {
    context.route() == Route::Compute
        // Fragments have the number of their primitive from there.
        && context.summary().has(Optional::GeometryShader)
        && bytes as u64 <= context.largest_storage_buffer()
}

/// The material of each triangle of the index buffer, where surfaces are drawn like this and there are any without maps. `bytes`: size of the
/// largest buffer of the geometry.
///
/// # Errors
/// Fails when the device is out of memory.
pub(in crate::passes) fn upload_material_numbers(
    recorder: &mut Recorder,
    (parts, clusters): (&[Part], &[Cluster]),
    triangles: usize,
    bytes: usize,
) -> Result<Option<Buffer>> {
    let are_plain = parts.iter().any(|p| p.kind == Kind::default());
    if !are_plain || !are_numbered(recorder.context(), bytes) {
        return Ok(None);
    }
    let numbers = material_numbers(parts, clusters, triangles);
    let bytes = bytemuck::cast_slice(&numbers);
    upload_buffer(
        recorder,
        "materials of triangles",
        BufferKind::Storage,
        bytes,
    )
    .map(Some)
}

fn material_numbers(parts: &[Part], clusters: &[Cluster], triangles: usize) -> Vec<u32> {
    let mut numbers = vec![0; triangles];
    for part in parts {
        for cluster in &clusters[part.clusters.clone()] {
            let [first, count] = [cluster.first, cluster.count].map(|i| i as usize / 3);
            numbers[first..first + count].fill(part.material);
        }
    }
    numbers
}

/// Both passes, and the numbers of the triangles.
pub(super) struct Triangles {
    draw: Pipeline,
    surfaces: Pipeline,
    numbers: Image,
}

/// The shader that writes so many images.
fn stage(targets: usize) -> &'static Shader {
    match targets {
        1 => &shaders::SURFACES_COMP,
        2 => &shaders::SURFACES_COMP_ALBEDO,
        _ => &shaders::SURFACES_COMP_ALBEDO_EMISSION,
    }
}

impl Triangles {
    /// Creates the passes for pictures of `size` pixels. `targets`: number of images of the G-buffer besides depth; `faces`: store the slopes of
    /// the face at each pixel.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(
        context: &Arc<Context>,
        size: [u32; 2],
        targets: usize,
        faces: bool,
    ) -> Result<Self> {
        let constants = [
            ("FACES", faces.into()),
            ("MATERIAL_COLUMNS", MATERIAL_COLUMNS),
        ];
        Ok(Self {
            draw: Pipeline::new(
                context,
                &PipelineDesc {
                    name: "triangles",
                    stages: &[&shaders::TRIANGLES_VERT, &shaders::TRIANGLES_FRAG],
                    vertex: &[Format::R32G32B32_SFLOAT],
                    colors: &[NUMBER],
                    depth: Depth::Write(Format::D32_SFLOAT),
                    blend: Blend::Off,
                    constants: &[],
                },
            )?,
            surfaces: compute(context, "G-buffer", stage(targets), &constants)?,
            numbers: Image::new(context, &ImageDesc::flat("triangles", NUMBER, size))?,
        })
    }

    /// The image that the first pass writes besides depth.
    pub fn target(&self) -> &Image {
        &self.numbers
    }

    /// Draws the surfaces without maps; other pixels are cleared.
    pub fn record(
        &self,
        recorder: &mut Recorder,
        geometry: &Geometry,
        view: &View,
        surfaces: &Surfaces,
    ) {
        let cull = Cull::camera(view);
        let clip_from_world = view.clip_from_world().to_cols_array_2d();
        recorder
            .pass("triangles", &self.draw)
            .color(&self.numbers, Load::Clear([0.0; 4]))
            .depth(&surfaces.depth, Load::Clear([0.0; 4]))
            .draws(|draws| {
                geometry.draw_numbered(draws, &cull, |draws, first| {
                    draws.push(&Push {
                        clip_from_world,
                        first,
                    });
                });
            });
        let pass = recorder
            .pass("G-buffer", &self.surfaces)
            .sample("triangles", &self.numbers, Sampler::Nearest)
            .sample("materials", geometry.materials(), Sampler::Nearest)
            .uniform("view", &view.block());
        let pass = geometry.bound_to(pass);
        surfaces.stored_by(pass).dispatch();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Bounds;

    #[test]
    fn each_triangle_has_the_material_of_its_part() {
        let cluster = |first, count| Cluster {
            first,
            count,
            bounds: Bounds::of([]),
            solid: None,
            normals_match_winding: true,
        };
        let clusters = [cluster(0, 6), cluster(6, 3), cluster(9, 9)];
        let part = |clusters, material| Part {
            clusters,
            material,
            kind: Kind::default(),
            casts: true,
            glass: None,
        };
        let parts = [part(2..3, 7), part(0..2, 4)];
        assert_eq!(material_numbers(&parts, &clusters, 6), [4, 4, 4, 7, 7, 7]);
    }

    #[test]
    fn the_shader_writes_the_images_that_there_are() {
        let writes = |targets| {
            let stores = stage(targets).bindings.iter().filter(|b| b.binding >= 40);
            stores.count()
        };
        assert_eq!([1, 2, 3].map(writes), [1, 2, 3]);
    }
}
