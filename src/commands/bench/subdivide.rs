//! Subdivision: more triangles on the same surfaces, to measure the cost of triangles alone.

use std::collections::HashMap;

use glam::{Vec2, Vec3};

use crate::scene::Scene;

/// Splits every triangle into `k`² similar ones (`k` at least 1). Neighbours still share the vertices of their edge;
/// normals are interpolated and normalised.
pub fn subdivided(scene: &Scene, k: u32) -> Scene {
    let mut splitter = Splitter {
        fine: Scene {
            indices: Vec::with_capacity(scene.indices.len() * (k * k) as usize),
            layout: None,
            bvh: None,
            ..scene.clone()
        },
        k,
        edges: HashMap::new(),
    };
    for triangle in scene.indices.chunks_exact(3) {
        splitter.split([triangle[0], triangle[1], triangle[2]]);
    }
    for part in &mut splitter.fine.parts {
        part.first_index *= k * k;
        part.index_count *= k * k;
    }
    splitter.fine
}

struct Splitter {
    fine: Scene,
    k: u32,
    /// Vertices on edges, by lower index, higher index and step from the lower.
    edges: HashMap<(u32, u32, u32), u32>,
}

impl Splitter {
    fn split(&mut self, corners: [u32; 3]) {
        let k = self.k;
        // Row by row, from the first edge to the third corner.
        let mut below: Vec<u32> = (0..=k).map(|i| self.vertex(corners, i, 0)).collect();
        for j in 1..=k {
            let above: Vec<u32> = (0..=k - j).map(|i| self.vertex(corners, i, j)).collect();
            for i in 0..above.len() {
                let fine = &mut self.fine.indices;
                fine.extend([below[i], below[i + 1], above[i]]);
                if i + 1 < above.len() {
                    fine.extend([below[i + 1], above[i + 1], above[i]]);
                }
            }
            below = above;
        }
    }

    /// The vertex `i` steps toward the second corner and `j` steps toward the third.
    fn vertex(&mut self, [a, b, c]: [u32; 3], i: u32, j: u32) -> u32 {
        match (i, j, self.k - i - j) {
            (_, _, 0) if i == 0 || j == 0 => {
                if j == 0 {
                    b
                } else {
                    c
                }
            }
            (0, 0, _) => a,
            (_, 0, _) => self.on_edge(a, b, i),
            (0, _, _) => self.on_edge(a, c, j),
            (_, _, 0) => self.on_edge(b, c, j),
            (_, _, rest) => self.blend([(a, rest), (b, i), (c, j)]),
        }
    }

    fn on_edge(&mut self, from: u32, to: u32, step: u32) -> u32 {
        let (low, high, step) = if from < to {
            (from, to, step)
        } else {
            (to, from, self.k - step)
        };
        if let Some(known) = self.edges.get(&(low, high, step)) {
            return *known;
        }
        let made = self.blend([(low, self.k - step), (high, step), (low, 0)]);
        self.edges.insert((low, high, step), made);
        made
    }

    /// Adds a vertex: the weighted mean of three.
    fn blend(&mut self, corners: [(u32, u32); 3]) -> u32 {
        let scene = &mut self.fine;
        let weighted = |of: &dyn Fn(usize) -> Vec3| -> Vec3 {
            let part = |(vertex, weight): (u32, u32)| of(vertex as usize) * weight as f32;
            corners.into_iter().map(part).sum::<Vec3>() / self.k as f32
        };
        let position = weighted(&|v| Vec3::from(scene.positions[v]));
        let normal = weighted(&|v| Vec3::from(scene.normals[v]));
        let texcoord = weighted(&|v| Vec2::from(scene.texcoords[v]).extend(0.0));
        scene.positions.push(position.into());
        // Opposite normals cancel out; use the first one then.
        let fallback = Vec3::from(scene.normals[corners[0].0 as usize]);
        let unit = normal.try_normalize().unwrap_or(fallback);
        scene.normals.push(unit.into());
        scene.texcoords.push(texcoord.truncate().into());
        if !scene.colours.is_empty() {
            let mix = |i: usize| {
                let part =
                    |(v, weight): (u32, u32)| u32::from(scene.colours[v as usize][i]) * weight;
                (corners.into_iter().map(part).sum::<u32>() / self.k) as u16
            };
            scene.colours.push(std::array::from_fn(mix));
        }
        if !scene.tangents.is_empty() {
            // Tangents are copied, not interpolated; the cost of drawing is the same.
            scene.tangents.push(scene.tangents[corners[0].0 as usize]);
        }
        (scene.positions.len() - 1) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{LoadOptions, bundled};

    fn area(scene: &Scene) -> f64 {
        let corner = |i: u32| Vec3::from(scene.positions[i as usize]);
        let triangles = scene.indices.chunks_exact(3);
        triangles
            .map(|t| {
                let [a, b, c] = [corner(t[0]), corner(t[1]), corner(t[2])];
                f64::from(0.5 * (b - a).cross(c - a).length())
            })
            .sum()
    }

    #[test]
    fn surfaces_parts_and_shared_edges_stay() {
        let scene = bundled(&LoadOptions::default()).expect("a scene").scene;
        let fine = subdivided(&scene, 3);
        assert_eq!(fine.triangles(), 9 * scene.triangles());
        let (old, new) = (area(&scene), area(&fine));
        assert!((new / old - 1.0).abs() < 1e-4, "{old} m² became {new}");
        let parts: u32 = fine.parts.iter().map(|p| p.index_count).sum();
        assert_eq!(parts as usize, fine.indices.len());
        // Two new vertices on each edge, shared between its triangles, and one inside each triangle.
        let edges: std::collections::HashSet<(u32, u32)> = scene
            .indices
            .chunks_exact(3)
            .flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])])
            .map(|(a, b)| (a.min(b), a.max(b)))
            .collect();
        let expected = scene.positions.len() + 2 * edges.len() + scene.triangles();
        assert_eq!(fine.positions.len(), expected);
        assert_eq!(fine.normals.len(), fine.positions.len());
        assert_eq!(fine.texcoords.len(), fine.positions.len());
    }

    #[test]
    fn colours_and_tangents_are_interpolated_too() {
        let mut scene = bundled(&LoadOptions::default()).expect("a scene").scene;
        let vertices = scene.positions.len();
        scene.colours = vec![[65_535, 100, 0, 65_535]; vertices];
        scene.tangents = vec![[32_767, 0, 0, -32_767]; vertices];
        let fine = subdivided(&scene, 2);
        assert_eq!(fine.colours, vec![scene.colours[0]; fine.positions.len()]);
        assert_eq!(fine.tangents, vec![scene.tangents[0]; fine.positions.len()]);
    }

    #[test]
    fn one_piece_changes_nothing() {
        let mut scene = bundled(&LoadOptions::default()).expect("a scene").scene;
        // The layout is valid only for the original indices.
        scene.layout = None;
        assert_eq!(subdivided(&scene, 1), scene);
    }
}
