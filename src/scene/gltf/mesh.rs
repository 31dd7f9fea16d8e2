//! Primitives of glTF meshes: triangle lists, strips and fans, with vertex attributes.

use glam::{Vec2, Vec3};
use gltf::Semantic;
use gltf::mesh::Mode;

use crate::scene::Scene;
use crate::scene::gltf::buffers::Buffers;
use crate::scene::gltf::material::Surface;
use crate::scene::mesh::arena::append_soup;
use crate::scene::mesh::instance::Mesh;
use crate::scene::mesh::soup;
use crate::scene::mesh::soup::{Corner, Dropped, MaterialUse, NONE, Soup, Triangle, usable_face};
use crate::scene::texture::normal_map::usable_tangent;

/// The triangles of a primitive. All attributes have the same length, and indices are in range.
#[derive(Debug, Default)]
pub struct Faces {
    positions: Vec<[f32; 3]>,
    normals: Option<Vec<[f32; 3]>>,
    /// In texture space, v pointing down; empty for (0, 0) everywhere.
    texcoords: Vec<[f32; 2]>,
    colours: Option<Vec<[f32; 4]>>,
    tangents: Option<Vec<[f32; 4]>>,
    pub indices: Vec<u32>,
}

/// Reads a primitive with at most `limit` corners; `None` for points and lines.
pub fn read_faces(
    buffers: &Buffers,
    primitive: &gltf::Primitive<'_>,
    surface: Surface,
    limit: usize,
) -> Result<Option<Faces>, String> {
    let mode = primitive.mode();
    if !matches!(
        mode,
        Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan
    ) {
        return Ok(None);
    }
    let positions = primitive
        .get(&Semantic::Positions)
        .ok_or("it has no positions")?;
    let positions = buffers.floats::<3>(&positions, limit)?;
    let count = positions.len();
    let indices = match primitive.indices() {
        Some(accessor) => buffers.indices(&accessor, limit)?,
        None => (0..count as u32).collect(),
    };
    if indices.iter().any(|i| *i as usize >= count) {
        return Err(format!("an index exceeds the {count} vertices"));
    }
    let mut faces = Faces {
        indices: as_triangles(indices, mode),
        positions,
        normals: read(buffers, primitive, &Semantic::Normals, count)?,
        tangents: None,
        texcoords: Vec::new(),
        colours: read_colours(buffers, primitive, count)?,
    };
    if surface.material.has_normal_map {
        faces.tangents = read(buffers, primitive, &Semantic::Tangents, count)?;
    }
    let set = Semantic::TexCoords(surface.texcoord_set);
    faces.texcoords = read(buffers, primitive, &set, count)?.unwrap_or_default();
    for uv in &mut faces.texcoords {
        let transformed = surface
            .material
            .texture_from_mesh
            .transform_point2(Vec2::from(*uv));
        *uv = if transformed.is_finite() {
            transformed.into()
        } else {
            [0.0; 2]
        };
    }
    Ok(Some(faces))
}

fn read<const N: usize>(
    buffers: &Buffers,
    primitive: &gltf::Primitive<'_>,
    what: &Semantic,
    count: usize,
) -> Result<Option<Vec<[f32; N]>>, String> {
    let Some(accessor) = primitive.get(what) else {
        return Ok(None);
    };
    if accessor.count() != count {
        return Err("its attributes differ in length".to_owned());
    }
    buffers.floats::<N>(&accessor, count).map(Some)
}

/// Linear RGBA; alpha is optional.
fn read_colours(
    buffers: &Buffers,
    primitive: &gltf::Primitive<'_>,
    count: usize,
) -> Result<Option<Vec<[f32; 4]>>, String> {
    let what = Semantic::Colors(0);
    let colours = read::<4>(buffers, primitive, &what, count)?;
    let has_alpha = primitive
        .get(&what)
        .is_some_and(|a| a.dimensions() == gltf::accessor::Dimensions::Vec4);
    Ok(colours.map(|mut colours| {
        for [r, g, b, a] in &mut colours {
            *a = if has_alpha { *a } else { 1.0 };
            for v in [r, g, b, a] {
                *v = if v.is_finite() { *v } else { 1.0 };
            }
        }
        colours
    }))
}

fn as_triangles(indices: Vec<u32>, mode: Mode) -> Vec<u32> {
    match mode {
        Mode::TriangleStrip => indices
            .windows(3)
            .enumerate()
            // Every second triangle of a strip has the opposite winding.
            .flat_map(|(i, w)| {
                if i % 2 == 0 {
                    [w[0], w[1], w[2]]
                } else {
                    [w[1], w[0], w[2]]
                }
            })
            .collect(),
        Mode::TriangleFan => match indices.split_first() {
            Some((hub, rim)) => rim.windows(2).flat_map(|w| [*hub, w[0], w[1]]).collect(),
            None => indices,
        },
        _ => {
            let mut indices = indices;
            indices.truncate(indices.len() / 3 * 3);
            indices
        }
    }
}

impl Faces {
    /// Adds attributes the renderer needs and the file lacks: normals (flat, or smooth below the crease angle) and tangents.
    pub fn into_mesh(mut self, surface: Surface, smooth_deg: Option<f32>) -> (Mesh, Dropped) {
        let needs_tangents = surface.material.has_normal_map && self.tangents.is_none();
        if needs_tangents || !self.has_usable_normals() {
            return self.rebuild(surface, smooth_deg);
        }
        let mut dropped = Dropped::default();
        let at = |i: u32| Vec3::from(self.positions[i as usize]);
        let mut kept = Vec::with_capacity(self.indices.len());
        for t in self.indices.chunks_exact(3) {
            if usable_face([at(t[0]), at(t[1]), at(t[2])], &mut dropped).is_some() {
                kept.extend_from_slice(t);
            }
        }
        self.indices = kept;
        (self.finish(surface.material.index), dropped)
    }

    fn has_usable_normals(&self) -> bool {
        let usable = |n: &[f32; 3]| {
            let length = Vec3::from(*n).length_squared();
            (0.25..4.0).contains(&length)
        };
        self.normals.as_ref().is_some_and(|n| n.iter().all(usable))
    }

    fn finish(self, material: u32) -> Mesh {
        let count = self.positions.len();
        let normals: Vec<Vec3> = self
            .normals
            .into_iter()
            .flatten()
            .map(|n| Vec3::from(n).normalize())
            .collect();
        let tangents = self.tangents.map(|tangents| {
            let both = tangents.into_iter().zip(&normals);
            both.map(|(t, n)| usable_tangent(t, *n)).collect()
        });
        let mut texcoords = self.texcoords;
        texcoords.resize(count, [0.0; 2]);
        Mesh {
            positions: self.positions.into_iter().map(Vec3::from).collect(),
            normals,
            texcoords,
            colours: self.colours,
            tangents,
            indices: self.indices,
            material,
        }
    }

    /// Rebuilds the mesh from a triangle soup, which computes missing normals and tangents.
    fn rebuild(self, surface: Surface, smooth_deg: Option<f32>) -> (Mesh, Dropped) {
        let has_texcoords = !self.texcoords.is_empty();
        let has_normals = self.normals.is_some();
        let index = |i: u32, exists: bool| if exists { i } else { NONE };
        let corner = |i: u32| Corner {
            position: i,
            texcoord: index(i, has_texcoords),
            normal: index(i, has_normals),
        };
        let triangle = |t: &[u32]| Triangle {
            corners: [corner(t[0]), corner(t[1]), corner(t[2])],
            material: 0,
            smoothing: 0,
        };
        // In a soup, v points up.
        let flipped = |uv: [f32; 2]| Vec2::new(uv[0], 1.0 - uv[1]);
        let mut soup = Soup {
            positions: self.positions.into_iter().map(Vec3::from).collect(),
            colours: self.colours.unwrap_or_default(),
            texcoords: self.texcoords.into_iter().map(flipped).collect(),
            normals: self.normals.into_iter().flatten().map(Vec3::from).collect(),
            triangles: self.indices.chunks_exact(3).map(triangle).collect(),
            polygons: soup::Polygons::default(),
        };
        let (dropped, faces) = soup.drop_unusable();
        let material = MaterialUse {
            has_normal_map: surface.material.has_normal_map,
            ..MaterialUse::plain(0)
        };
        let mut scene = Scene::default();
        append_soup(&mut scene, &soup, &faces, &[material], smooth_deg);
        (Mesh::of(scene, surface.material.index), dropped)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_their_winding() {
        let strip = as_triangles(vec![0, 1, 2, 3, 4], Mode::TriangleStrip);
        assert_eq!(strip, [0, 1, 2, 2, 1, 3, 2, 3, 4]);
        let fan = as_triangles(vec![9, 1, 2, 3], Mode::TriangleFan);
        assert_eq!(fan, [9, 1, 2, 9, 2, 3]);
        assert!(as_triangles(vec![], Mode::TriangleFan).is_empty());
        assert_eq!(as_triangles(vec![0, 1, 2, 3], Mode::Triangles), [0, 1, 2]);
    }
}
