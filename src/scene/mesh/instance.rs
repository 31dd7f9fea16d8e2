//! Instances: a mesh placed several times in a scene.

use glam::{Affine3A, Mat3, Vec2, Vec3};

use crate::scene::Scene;
use crate::scene::mesh::arena::Vertex;
use crate::scene::mesh::soup::{Dropped, NONE, usable_face};

/// Triangles with one material and their vertices, in mesh space.
#[derive(Debug)]
pub struct Mesh {
    pub positions: Vec<Vec3>,
    /// Unit length, one per position.
    pub normals: Vec<Vec3>,
    /// One per position, v pointing down.
    pub texcoords: Vec<[f32; 2]>,
    /// Linear RGBA, one per position.
    pub colours: Option<Vec<[f32; 4]>>,
    /// Unit length plus the sign of the bitangent, one per position.
    pub tangents: Option<Vec<[f32; 4]>>,
    /// Three per triangle, indexing `positions`.
    pub indices: Vec<u32>,
    /// Index of the material in the scene.
    pub material: u32,
}

impl Mesh {
    /// The mesh of a scene that contains a single mesh.
    pub fn of(scene: Scene, material: u32) -> Self {
        let unorm = |c: [u16; 4]| c.map(|v| f32::from(v) / f32::from(u16::MAX));
        let snorm = |t: [i16; 4]| t.map(|v| f32::from(v) / f32::from(i16::MAX));
        let has = |length: usize| length > 0;
        Self {
            colours: has(scene.colours.len())
                .then(|| scene.colours.into_iter().map(unorm).collect()),
            tangents: has(scene.tangents.len())
                .then(|| scene.tangents.into_iter().map(snorm).collect()),
            positions: scene.positions.into_iter().map(Vec3::from).collect(),
            normals: scene.normals.into_iter().map(Vec3::from).collect(),
            texcoords: scene.texcoords,
            indices: scene.indices,
            material,
        }
    }
}

/// Adds an instance of the mesh as a part, without unused vertices. Counts the triangles that the transform makes unusable. The
/// caller has checked the number of triangles.
pub fn append_instance(scene: &mut Scene, mesh: &Mesh, world_from_mesh: &Affine3A) -> Dropped {
    let linear = Mat3::from(world_from_mesh.matrix3);
    let determinant = linear.determinant();
    let mut dropped = Dropped::default();
    if determinant == 0.0 || !determinant.is_finite() || !world_from_mesh.is_finite() {
        // Some programs hide objects by scaling them to zero.
        dropped.degenerate = mesh.indices.len() / 3;
        return dropped;
    }
    let instance = Instance {
        mesh,
        world_from_mesh,
        normals: linear.inverse().transpose(),
        mirrored: determinant < 0.0,
    };
    let first_index = scene.indices.len();
    let mut indices_of = vec![NONE; mesh.positions.len()];
    for t in mesh.indices.chunks_exact(3) {
        let corners = [t[0], t[1], t[2]];
        let positions = corners.map(|i| instance.position(i));
        if !instance.keeps_area() && usable_face(positions, &mut dropped).is_none() {
            continue;
        }
        let mut indices = corners.map(|i| instance.index(scene, &mut indices_of, i));
        if instance.mirrored {
            indices.swap(1, 2);
        }
        scene.indices.extend(indices);
    }
    scene.finish_part(first_index, mesh.material, mesh.colours.is_some());
    dropped
}

struct Instance<'m> {
    mesh: &'m Mesh,
    world_from_mesh: &'m Affine3A,
    normals: Mat3,
    mirrored: bool,
}

impl Instance<'_> {
    /// Whether scale and translation are moderate enough to keep all triangles usable.
    fn keeps_area(&self) -> bool {
        let m = self.world_from_mesh.matrix3;
        let lengths = [m.x_axis, m.y_axis, m.z_axis].map(|axis| axis.length());
        let near = lengths.iter().all(|l| (0.01..100.0).contains(l));
        near && self.world_from_mesh.translation.length() < 1e5
    }

    fn position(&self, i: u32) -> Vec3 {
        let position = self.mesh.positions[i as usize];
        self.world_from_mesh.transform_point3(position)
    }

    /// Index of a vertex in the scene, added on first use.
    fn index(&self, scene: &mut Scene, indices_of: &mut [u32], i: u32) -> u32 {
        let known = &mut indices_of[i as usize];
        if *known == NONE {
            *known = scene.push_vertex(self.vertex(i));
        }
        *known
    }

    fn vertex(&self, i: u32) -> Vertex {
        let at = i as usize;
        let tangent = self.mesh.tangents.as_ref().map(|tangents| {
            let [x, y, z, sign] = tangents[at];
            let rotated = self
                .world_from_mesh
                .transform_vector3(Vec3::new(x, y, z))
                .normalize_or_zero();
            let sign = if self.mirrored { -sign } else { sign };
            rotated.extend(sign).to_array()
        });
        Vertex {
            position: self.position(i),
            normal: (self.normals * self.mesh.normals[at]).normalize_or(Vec3::Y),
            texcoord: Vec2::from(self.mesh.texcoords[at]),
            colour: self.mesh.colours.as_ref().map(|colours| colours[at]),
            tangent,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh() -> Mesh {
        Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::NAN],
            normals: vec![Vec3::Z; 4],
            texcoords: vec![[0.0; 2]; 4],
            colours: None,
            tangents: Some(vec![[1.0, 0.0, 0.0, 1.0]; 4]),
            indices: vec![0, 1, 2],
            material: 0,
        }
    }

    #[test]
    fn instances_have_vertices_of_their_own() {
        let mut scene = Scene::default();
        for x in [0.0, 5.0] {
            let transform = Affine3A::from_translation(Vec3::new(x, 0.0, 0.0));
            assert_eq!(
                append_instance(&mut scene, &mesh(), &transform),
                Dropped::default()
            );
        }
        assert_eq!(scene.positions.len(), 6, "the unused vertex is not added");
        assert_eq!(scene.indices, [0, 1, 2, 3, 4, 5]);
        assert_eq!(scene.parts[1].bounds.max.x, 6.0);
    }

    #[test]
    fn mirroring_flips_winding_normals_and_bitangents() {
        let mut scene = Scene::default();
        let transform = Affine3A::from_scale(Vec3::new(1.0, 1.0, -1.0));
        append_instance(&mut scene, &mesh(), &transform);
        assert_eq!(scene.indices, [0, 2, 1]);
        assert_eq!(scene.normals[0], [0.0, 0.0, -1.0]);
        assert_eq!(scene.tangents[0], [i16::MAX, 0, 0, -i16::MAX]);
    }

    #[test]
    fn unusable_transforms_drop_everything() {
        let mut scene = Scene::default();
        for transform in [
            Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0)),
            Affine3A::from_scale(Vec3::splat(1e-30)),
            Affine3A::from_scale(Vec3::splat(1e30)),
            Affine3A::from_translation(Vec3::splat(f32::NAN)),
        ] {
            let dropped = append_instance(&mut scene, &mesh(), &transform);
            assert_eq!(dropped.not_finite + dropped.degenerate, 1, "{transform:?}");
        }
        assert!(scene.indices.is_empty() && scene.parts.is_empty());
    }
}
