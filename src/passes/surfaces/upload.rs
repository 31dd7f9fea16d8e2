//! Uploads of a scene's vertices, textures and materials.

use glam::Vec3;

use crate::daylight::microfacet;
use crate::gpu::{
    Buffer, BufferKind, Format, Image, ImageDesc, Recorder, Result, upload_buffer, upload_texture,
};
use crate::scene::{Encoding, Material, Scene, Texture};

use crate::passes::kilo;
use crate::passes::surfaces::geometry::Surface;

/// Uploads colours and tangents for every vertex; a scene without them gets white and zero tangents.
pub(in crate::passes) fn upload_details(
    recorder: &mut Recorder,
    scene: &Scene,
) -> Result<[Buffer; 2]> {
    let vertices = scene.positions.len();
    let (white, none) = (vec![[u16::MAX; 4]; vertices], vec![[0i16; 4]; vertices]);
    let given = |length: usize| length == vertices;
    let colours = if given(scene.colours.len()) {
        &scene.colours
    } else {
        &white
    };
    let tangents = if given(scene.tangents.len()) {
        &scene.tangents
    } else {
        &none
    };
    let colours = bytemuck::cast_slice(colours);
    let tangents = bytemuck::cast_slice(tangents);
    Ok([
        upload_buffer(recorder, "colours", BufferKind::Vertex, colours)?,
        upload_buffer(recorder, "tangents", BufferKind::Vertex, tangents)?,
    ])
}

/// Materials per row of the table of materials.
pub(in crate::passes) const MATERIAL_COLUMNS: u32 = 1024;

/// Texel rows of as many materials as there are columns.
const MATERIAL_ROWS: usize = 3;

/// Uploads the table of `include/materials.glsl`.
pub(in crate::passes) fn upload_materials(
    recorder: &mut Recorder,
    materials: &[Material],
) -> Result<Image> {
    let columns = MATERIAL_COLUMNS as usize;
    let rows = MATERIAL_ROWS * materials.len().div_ceil(columns).max(1);
    let is_rough = materials.iter().any(|m| m.microfacet.is_some());
    let lobes = if is_rough { lobe_table() } else { Vec::new() };
    let rows_of_lobes = lobes.len().div_ceil(columns);
    let mut table = vec![[0.0f32; 4]; (rows + rows_of_lobes) * columns];
    table[rows * columns..][..lobes.len()].copy_from_slice(&lobes);
    for (i, material) in materials.iter().enumerate() {
        let at = i / columns * MATERIAL_ROWS * columns + i % columns;
        let [diffuse, specular, emission] = texels(material);
        table[at] = diffuse;
        table[at + columns] = specular;
        table[at + 2 * columns] = emission;
    }
    let size = [MATERIAL_COLUMNS, (rows + rows_of_lobes) as u32];
    let desc = ImageDesc::texture("materials", Format::R32G32B32A32_SFLOAT, size);
    upload_texture(recorder, &desc, &[bytemuck::cast_slice(&table)])
}

/// The reflectance of lobes behind the materials, see `include/microfacet.glsl`: each texel with the next column.
fn lobe_table() -> Vec<[f32; 4]> {
    let albedo = microfacet::table();
    let last = albedo.len() - 1;
    let pair = |k: usize| {
        let ([a, b], [c, d]) = (albedo[k], albedo[(k + 1).min(last)]);
        [a, b, c, d]
    };
    (0..albedo.len()).map(pair).collect()
}

/// The rows of a material in the table.
fn texels(material: &Material) -> [[f32; 4]; 3] {
    let row = |[r, g, b]: [f32; 3], a: f32| [r, g, b, a];
    let emission = kilo(Vec3::from(material.emission).as_dvec3()).to_array();
    match material.microfacet {
        Some(facets) => [
            row(facets.base, facets.f90),
            row(facets.f0, -1.0 - facets.roughness),
            row(emission, facets.metallic),
        ],
        None => [
            row(material.diffuse, 0.0),
            row(material.specular, material.shininess),
            row(emission, 0.0),
        ],
    }
}

pub(in crate::passes) fn surface(material: &Material) -> Surface {
    let facets = material.microfacet;
    Surface {
        diffuse: facets.map_or(material.diffuse, |m| m.base).into(),
        diffuse_map: material.diffuse_texture,
        specular_map: facets.map_or(material.specular_texture, |m| m.texture),
        metallic: facets.map(|m| m.metallic),
        normal_map: material.normal_texture,
        emissive_map: material.emissive_texture.filter(|_| material.is_emissive()),
        emission: material.emission.into(),
        normal_scale: material.normal_scale,
        is_specular: material.specular != [0.0; 3],
        // The material's opacity multiplies that of the map; dividing the cutoff by it gives the same test.
        cutoff: material
            .alpha_cutoff
            .map(|c| c / material.dissolve.max(1e-6)),
    }
}

pub(in crate::passes) fn white() -> Texture {
    Texture {
        name: "white".into(),
        width: 1,
        height: 1,
        rgba8: vec![255; 4],
        encoding: Encoding::Srgb,
        wrap: Default::default(),
    }
}

pub(in crate::passes) fn upload(recorder: &mut Recorder, texture: &Texture) -> Result<Image> {
    let smaller = texture.mip_levels();
    let levels: Vec<&[u8]> = std::iter::once(texture.rgba8.as_slice())
        .chain(smaller.iter().map(|t| t.rgba8.as_slice()))
        .collect();
    let format = match texture.encoding {
        Encoding::Srgb => Format::R8G8B8A8_SRGB,
        Encoding::Linear => Format::R8G8B8A8_UNORM,
    };
    let desc = ImageDesc {
        levels: levels.len() as u32,
        ..ImageDesc::texture(&texture.name, format, [texture.width, texture.height])
    };
    upload_texture(recorder, &desc, &levels)
}
