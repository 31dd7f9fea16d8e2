//! The arena of vertices, indices and parts of a scene, and welding of triangle soups into it.

use glam::{Vec2, Vec3};

use crate::scene::bounds::Bounds;
use crate::scene::mesh::normals::corner_normals;
use crate::scene::mesh::soup::{Corner, MaterialUse, NONE, Soup, Triangle};
use crate::scene::texture::normal_map::TangentInput;
use crate::scene::{Part, Scene};

/// Maximum number of vertices at one position that are compared with a new corner. Beyond it, equal corners are not welded;
/// this bounds the time for malicious files.
const MAX_COMPARED: usize = 64;

/// A vertex of the arena.
#[derive(Debug, Clone, Copy)]
pub struct Vertex {
    /// World space, metres.
    pub position: Vec3,
    /// World space, unit length.
    pub normal: Vec3,
    /// (0, 0) is the corner of the first texel of the first row.
    pub texcoord: Vec2,
    /// Linear RGBA.
    pub colour: Option<[f32; 4]>,
    /// World space, unit length, followed by the sign of the bitangent.
    pub tangent: Option<[f32; 4]>,
}

impl Scene {
    /// Appends a vertex; returns its index.
    pub(in crate::scene) fn push_vertex(&mut self, vertex: Vertex) -> u32 {
        let number = self.positions.len();
        self.positions.push(vertex.position.to_array());
        self.normals.push(vertex.normal.to_array());
        self.texcoords.push(vertex.texcoord.to_array());
        if let Some(colour) = vertex.colour {
            self.colours.resize(number, [u16::MAX; 4]);
            let unorm = |v: f32| (v.clamp(0.0, 1.0) * f32::from(u16::MAX)).round() as u16;
            self.colours.push(colour.map(unorm));
        }
        if let Some(tangent) = vertex.tangent {
            self.tangents.resize(number, [0; 4]);
            let snorm = |v: f32| (v.clamp(-1.0, 1.0) * f32::from(i16::MAX)).round() as i16;
            self.tangents.push(tangent.map(snorm));
        }
        number as u32
    }

    /// Appends the part starting at `first_index`, unless it has no triangles.
    pub(in crate::scene) fn finish_part(
        &mut self,
        first_index: usize,
        material: u32,
        has_colours: bool,
    ) {
        if self.indices.len() == first_index {
            return;
        }
        let drawn = &self.indices[first_index..];
        let bounds = Bounds::of(
            drawn
                .iter()
                .map(|i| Vec3::from(self.positions[*i as usize])),
        );
        self.bounds = self.bounds.union(bounds);
        self.parts.push(Part {
            first_index: first_index as u32,
            index_count: drawn.len() as u32,
            material,
            has_colours,
            bounds,
        });
    }

    /// Whether this many more corners fit into 32-bit indices.
    pub(in crate::scene) fn has_indices_for(&self, corners: usize) -> bool {
        let most = self.positions.len().max(self.indices.len());
        most.saturating_add(corners) < u32::MAX as usize
    }
}

/// Appends the usable triangles of a soup with their face normals. Equal corners are welded into one vertex, and the triangles
/// of each material become one part. The caller has checked the number of triangles.
pub fn append_soup(
    scene: &mut Scene,
    soup: &Soup,
    faces: &[Vec3],
    uses: &[MaterialUse],
    smooth_deg: Option<f32>,
) {
    let normals = corner_normals(soup, faces, smooth_deg);
    let mut by_use: Vec<Vec<u32>> = vec![Vec::new(); uses.len()];
    for (i, triangle) in soup.triangles.iter().enumerate() {
        by_use[triangle.material as usize].push(i as u32);
    }
    let mut order: Vec<usize> = (0..uses.len()).collect();
    order.sort_by_key(|i| uses[*i].index);
    let mut welder = Welder::new(soup.positions.len());
    for i in order {
        let triangles = &by_use[i];
        let mut part = PartBuilder {
            soup,
            normals: &normals,
            tangents: Vec::new(),
            material: uses[i],
        };
        if part.material.has_normal_map {
            part.tangents = part.compute_tangents(triangles);
        }
        part.append(scene, triangles, &mut welder);
    }
}

struct PartBuilder<'s> {
    soup: &'s Soup,
    normals: &'s [[Vec3; 3]],
    /// One per corner of the part's triangles; empty without a normal map.
    tangents: Vec<[f32; 4]>,
    material: MaterialUse,
}

impl PartBuilder<'_> {
    fn append(&self, scene: &mut Scene, triangles: &[u32], welder: &mut Welder) {
        let first_index = scene.indices.len();
        welder.begin(scene.positions.len());
        for (i, &number) in triangles.iter().enumerate() {
            let triangle = &self.soup.triangles[number as usize];
            for (k, corner) in triangle.corners.iter().enumerate() {
                let tangent = self.tangents.get(3 * i + k).copied();
                let vertex = self.vertex(*corner, self.normals[number as usize][k], tangent);
                let index = welder.index(scene, corner.position, &vertex);
                scene.indices.push(index);
            }
        }
        scene.finish_part(
            first_index,
            self.material.index,
            !self.soup.colours.is_empty(),
        );
    }

    fn vertex(&self, corner: Corner, normal: Vec3, tangent: Option<[f32; 4]>) -> Vertex {
        let uv = self.texcoord(corner);
        let coloured = !self.soup.colours.is_empty();
        Vertex {
            position: self.soup.position(corner),
            normal,
            // In OBJ v points up from the last row, in Vulkan down from the first.
            texcoord: Vec2::new(uv.x, 1.0 - uv.y),
            colour: coloured.then(|| self.soup.colour_of(corner.position)),
            tangent,
        }
    }

    /// v points up.
    fn texcoord(&self, corner: Corner) -> Vec2 {
        let placed = self
            .material
            .texture_from_mesh
            .transform_point2(self.soup.texcoord(corner));
        if placed.is_finite() {
            placed
        } else {
            Vec2::ZERO
        }
    }

    fn compute_tangents(&self, triangles: &[u32]) -> Vec<[f32; 4]> {
        let mut corners = TangentInput::default();
        for &number in triangles {
            let Triangle { corners: of, .. } = &self.soup.triangles[number as usize];
            for (corner, normal) in of.iter().zip(self.normals[number as usize]) {
                corners.positions.push(self.soup.position(*corner).into());
                corners.normals.push(normal.into());
                corners.texcoords.push(self.texcoord(*corner).into());
            }
        }
        corners.compute_tangents();
        corners.tangents
    }
}

/// Finds equal vertices in the part being built.
struct Welder {
    /// For each position, its most recent vertex, or [`NONE`].
    newest: Vec<u32>,
    /// For each vertex of the part, the previous vertex at the same position, or [`NONE`].
    before: Vec<u32>,
    /// Positions used by the part, to reset `newest`.
    used: Vec<u32>,
    first: usize,
}

impl Welder {
    fn new(positions: usize) -> Self {
        Self {
            newest: vec![NONE; positions],
            before: Vec::new(),
            used: Vec::new(),
            first: 0,
        }
    }

    /// Starts a part whose first vertex has index `first`.
    fn begin(&mut self, first: usize) {
        for position in self.used.drain(..) {
            self.newest[position as usize] = NONE;
        }
        self.before.clear();
        self.first = first;
    }

    /// Index of a vertex, added on first use.
    fn index(&mut self, scene: &mut Scene, position: u32, vertex: &Vertex) -> u32 {
        let mut known = self.newest[position as usize];
        for _ in 0..MAX_COMPARED {
            if known == NONE {
                break;
            }
            if self.agrees(scene, known as usize, vertex) {
                return known;
            }
            known = self.before[known as usize - self.first];
        }
        let index = scene.push_vertex(*vertex);
        self.before.push(self.newest[position as usize]);
        self.used.push(position);
        self.newest[position as usize] = index;
        index
    }

    /// Whether normal, texture coordinate and tangent match; position and colour already do.
    fn agrees(&self, scene: &Scene, known: usize, vertex: &Vertex) -> bool {
        let near = |i: i16, v: f32| (f32::from(i) / f32::from(i16::MAX) - v).abs() < 1e-3;
        scene.normals[known] == vertex.normal.to_array()
            && scene.texcoords[known] == vertex.texcoord.to_array()
            && vertex.tangent.is_none_or(|t| {
                scene.tangents[known]
                    .into_iter()
                    .zip(t)
                    .all(|(i, v)| near(i, v))
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Affine2;

    fn one_triangle() -> Soup {
        let corner = |position| Corner {
            position,
            texcoord: NONE,
            normal: 0,
        };
        Soup {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            normals: vec![Vec3::ZERO],
            triangles: vec![Triangle {
                corners: [0, 1, 2].map(corner),
                material: 0,
                smoothing: 0,
            }],
            ..Soup::default()
        }
    }

    fn scene_of(mut soup: Soup, material: MaterialUse) -> Scene {
        let (_, faces) = soup.drop_unusable();
        let mut scene = Scene::default();
        append_soup(&mut scene, &soup, &faces, &[material], None);
        scene
    }

    #[test]
    fn equal_corners_become_one_vertex() {
        let mut soup = one_triangle();
        soup.triangles.push(soup.triangles[0]);
        let scene = scene_of(soup, MaterialUse::plain(0));
        let sizes = (
            scene.positions.len(),
            scene.indices.len(),
            scene.parts.len(),
        );
        assert_eq!(sizes, (3, 6, 1));
        assert_eq!(
            scene.normals[0],
            [0.0, 0.0, 1.0],
            "a zero normal is replaced by the face's"
        );
        assert_eq!(scene.texcoords[0], [0.0, 1.0]);
        assert!(scene.colours.is_empty() && scene.tangents.is_empty());
    }

    #[test]
    fn colours_and_tangents_exist_only_where_needed() {
        let mut soup = one_triangle();
        soup.colours = vec![[0.0, 1.0, 0.5, 1.0]];
        let material = MaterialUse {
            has_normal_map: true,
            ..MaterialUse::plain(0)
        };
        let scene = scene_of(soup, material);
        assert_eq!(scene.colours[0], [0, u16::MAX, 32_768, u16::MAX]);
        assert_eq!(scene.colours[2], [u16::MAX; 4]);
        assert_eq!(scene.tangents.len(), 3);
        assert!(scene.parts[0].has_colours);
    }

    #[test]
    fn texture_coordinates_are_transformed_before_v_is_flipped() {
        let mut soup = one_triangle();
        soup.texcoords = vec![Vec2::new(0.25, 0.5)];
        soup.triangles[0].corners[0].texcoord = 0;
        let material = MaterialUse {
            texture_from_mesh: Affine2::from_scale(Vec2::new(2.0, 3.0)),
            ..MaterialUse::plain(0)
        };
        assert_eq!(scene_of(soup, material).texcoords[0], [0.5, -0.5]);
    }
}
