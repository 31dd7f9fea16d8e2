//! Lines of a drawing of a scene: where a plane cuts it, and the outlines of its panes.

use std::collections::HashMap;

use glam::Vec3;

use super::Scene;

impl Scene {
    /// Where the plane of points p with `normal` · p = `offset` cuts surfaces that are no panes: line after line.
    pub fn section(&self, normal: Vec3, offset: f32) -> Vec<[Vec3; 2]> {
        let mut lines = Vec::new();
        for corners in self.corners_of(false) {
            let heights = corners.map(|corner| normal.dot(corner) - offset);
            let crossing = |k: usize| {
                let [a, b] = [k, (k + 1) % 3];
                // A corner in the plane counts as above it, so that each crossing is found once.
                let is_crossed = (heights[a] >= 0.0) != (heights[b] >= 0.0);
                let share = heights[a] / (heights[a] - heights[b]);
                is_crossed.then(|| corners[a].lerp(corners[b], share))
            };
            let mut points = (0..3).filter_map(crossing);
            if let (Some(from), Some(to)) = (points.next(), points.next())
                && from != to
            {
                lines.push([from, to]);
            }
        }
        lines
    }

    /// Edges of panes of glass that belong to one triangle alone.
    pub fn pane_edges(&self) -> Vec<[Vec3; 2]> {
        let mut edges: HashMap<[[u32; 3]; 2], ([Vec3; 2], usize)> = HashMap::new();
        let mut order = Vec::new();
        for corners in self.corners_of(true) {
            for k in 0..3 {
                let ends = [corners[k], corners[(k + 1) % 3]];
                let mut key = ends.map(|end| end.to_array().map(f32::to_bits));
                key.sort_unstable();
                let known = edges.entry(key).or_insert_with(|| {
                    order.push(key);
                    (ends, 0)
                });
                known.1 += 1;
            }
        }
        let once = order.iter().filter_map(|key| edges.get(key));
        once.filter(|(_, count)| *count == 1)
            .map(|(ends, _)| *ends)
            .collect()
    }

    /// Triangles of panes, or of all else.
    fn corners_of(&self, of_glass: bool) -> impl Iterator<Item = [Vec3; 3]> {
        let wanted = self
            .parts
            .iter()
            .filter(move |part| self.materials[part.material as usize].glass.is_some() == of_glass);
        wanted.flat_map(|part| {
            let first = part.first_index as usize;
            let indices = &self.indices[first..first + part.index_count as usize];
            indices
                .chunks_exact(3)
                .map(|triangle| [0, 1, 2].map(|k| Vec3::from(self.positions[triangle[k] as usize])))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Bounds, Material, Part};

    /// A wall of 4 x 3 m on z = 0 from the ground, and a pane of glass before it if asked for.
    fn wall(is_pane: bool) -> Scene {
        let square = |z: f32| [[0.0, 0.0, z], [4.0, 0.0, z], [4.0, 3.0, z], [0.0, 3.0, z]];
        let mut scene = Scene {
            positions: [square(0.0), square(1.0)].concat(),
            indices: vec![0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7],
            materials: vec![
                Material::default(),
                Material {
                    glass: is_pane.then_some([0.8; 3]),
                    ..Material::default()
                },
            ],
            ..Scene::default()
        };
        for material in 0..2 {
            scene.parts.push(Part {
                first_index: 6 * material,
                index_count: 6,
                material,
                has_colours: false,
                bounds: Bounds::EMPTY,
            });
        }
        scene
    }

    #[test]
    fn a_plane_cuts_a_wall_along_its_length() {
        for height in [0.8, 1.5, 3.0] {
            let lines = wall(true).section(Vec3::Y, height);
            let length: f32 = lines.iter().map(|[a, b]| a.distance(*b)).sum();
            assert!((length - 4.0).abs() < 1e-5, "{height}: {lines:?}");
            assert!(lines.iter().flatten().all(|p| (p.y - height).abs() < 1e-6));
        }
        assert!(wall(true).section(Vec3::Y, 3.1).is_empty());
        let all = wall(false).section(Vec3::Y, 0.8);
        let length: f32 = all.iter().map(|[a, b]| a.distance(*b)).sum();
        assert!((length - 8.0).abs() < 1e-5);
    }

    #[test]
    fn a_pane_has_four_edges() {
        let edges = wall(true).pane_edges();
        let length: f32 = edges.iter().map(|[a, b]| a.distance(*b)).sum();
        assert_eq!(edges.len(), 4, "the diagonal belongs to two");
        assert!((length - 14.0).abs() < 1e-5);
        assert!(wall(false).pane_edges().is_empty());
    }
}
