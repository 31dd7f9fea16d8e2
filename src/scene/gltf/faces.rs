//! The triangles of a primitive, and the attributes that the renderer needs and a file may lack.

use glam::{Vec2, Vec3};

use crate::scene::Scene;
use crate::scene::gltf::material::Surface;
use crate::scene::mesh::arena::append_soup;
use crate::scene::mesh::instance::Mesh;
use crate::scene::mesh::soup;
use crate::scene::mesh::soup::{Corner, Dropped, MaterialUse, NONE, Soup, Triangle, usable_face};
use crate::scene::texture::normal_map::usable_tangent;

/// The triangles of a primitive. All attributes have the same length, and indices are in range.
#[derive(Debug, Default)]
pub struct Faces {
    pub positions: Vec<[f32; 3]>,
    pub normals: Option<Vec<[f32; 3]>>,
    /// In texture space, v pointing down; empty for (0, 0) everywhere.
    pub texcoords: Vec<[f32; 2]>,
    pub colours: Option<Vec<[f32; 4]>>,
    pub tangents: Option<Vec<[f32; 4]>>,
    pub indices: Vec<u32>,
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
