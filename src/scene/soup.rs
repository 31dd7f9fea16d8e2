//! Triangles of one mesh between the file and the arena: world space, separate numbers for position, texture and normal.

use std::collections::BTreeMap;
use std::collections::HashMap;

use glam::{Affine3A, Mat3, Vec2, Vec3};

use super::bounds::Bounds;
use super::normals::corner_normals;
use super::{Part, Scene};

/// "No such number" of a [`Corner`].
pub(super) const NONE: u32 = u32::MAX;

/// Coordinates beyond this are dropped like infinities, metres: squares and sums of larger ones leave `f32`.
const MAX_COORDINATE: f32 = 1e9;

/// One corner of a triangle: numbers into the lists of [`Soup`], or [`NONE`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    pub position: u32,
    pub texcoord: u32,
    pub normal: u32,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Triangle {
    pub corners: [Corner; 3],
    /// Number of the material in the scene.
    pub material: u32,
    /// The smoothing group; 0 is none.
    pub smoothing: u32,
}

/// The triangles of one mesh.
#[derive(Debug, Default)]
pub(super) struct Soup {
    pub positions: Vec<Vec3>,
    pub texcoords: Vec<Vec2>,
    pub normals: Vec<Vec3>,
    pub triangles: Vec<Triangle>,
}

/// How many triangles [`Soup::sweep`] dropped.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub(super) struct Dropped {
    pub not_finite: usize,
    pub degenerate: usize,
}

impl Soup {
    pub fn position(&self, corner: Corner) -> Vec3 {
        self.positions[corner.position as usize]
    }

    /// The file's normal of a corner if it has a sound one.
    pub fn normal(&self, corner: Corner) -> Option<Vec3> {
        let normal = self.normals.get(corner.normal as usize)?;
        normal.is_finite().then(|| normal.try_normalize()).flatten()
    }

    /// Moves everything to world space. A mirroring transform also turns the triangles round, so that their winding and
    /// their normals keep agreeing.
    pub fn transform(&mut self, world_from_mesh: &Affine3A) {
        let linear = Mat3::from(world_from_mesh.matrix3);
        let normals = linear.inverse().transpose();
        for p in &mut self.positions {
            *p = world_from_mesh.transform_point3(*p);
        }
        for n in &mut self.normals {
            *n = (normals * *n).normalize_or_zero();
        }
        if linear.determinant() < 0.0 {
            self.triangles.iter_mut().for_each(|t| t.corners.swap(1, 2));
        }
    }

    /// Drops triangles with unusable positions or without area; the rest gets its unit face normals.
    pub fn sweep(&mut self) -> (Dropped, Vec<Vec3>) {
        let mut dropped = Dropped::default();
        let mut faces = Vec::with_capacity(self.triangles.len());
        let triangles = std::mem::take(&mut self.triangles);
        let usable = |p: Vec3| p.is_finite() && p.abs().max_element() <= MAX_COORDINATE;
        self.triangles = triangles
            .into_iter()
            .filter(|triangle| {
                let corners = triangle.corners.map(|c| self.position(c));
                if !corners.into_iter().all(usable) {
                    dropped.not_finite += 1;
                    return false;
                }
                let face = face_normal(corners);
                dropped.degenerate += usize::from(face.is_none());
                faces.extend(face);
                face.is_some()
            })
            .collect();
        (dropped, faces)
    }

    /// Appends the triangles to the scene: corners that agree in everything become one vertex, triangles of one material
    /// one part. Returns false when the scene has no numbers left for so many vertices.
    pub fn append_to(&self, scene: &mut Scene, faces: &[Vec3], smooth_deg: Option<f32>) -> bool {
        let normals = corner_normals(self, faces, smooth_deg);
        let mut by_material: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (i, triangle) in self.triangles.iter().enumerate() {
            by_material.entry(triangle.material).or_default().push(i);
        }
        let worst = scene.positions.len() + 3 * self.triangles.len();
        if worst.max(scene.indices.len() + 3 * self.triangles.len()) > u32::MAX as usize {
            return false;
        }
        for (material, triangles) in by_material {
            self.append_part(scene, material, &triangles, &normals);
        }
        true
    }

    fn append_part(
        &self,
        scene: &mut Scene,
        material: u32,
        triangles: &[usize],
        normals: &[[Vec3; 3]],
    ) {
        let first_index = scene.indices.len() as u32;
        let mut known: HashMap<(u32, u32, [u32; 3]), u32> = HashMap::with_capacity(triangles.len());
        let mut bounds = Bounds::EMPTY;
        for &i in triangles {
            for (corner, normal) in self.triangles[i].corners.iter().zip(normals[i]) {
                let key = (
                    corner.position,
                    corner.texcoord,
                    normal.to_array().map(f32::to_bits),
                );
                let index = *known.entry(key).or_insert_with(|| {
                    let position = self.position(*corner);
                    bounds = bounds.with(position);
                    self.push_vertex(scene, *corner, position, normal)
                });
                scene.indices.push(index);
            }
        }
        let index_count = scene.indices.len() as u32 - first_index;
        scene.bounds = scene.bounds.union(bounds);
        scene.parts.push(Part {
            first_index,
            index_count,
            material,
            bounds,
        });
    }

    fn push_vertex(&self, scene: &mut Scene, corner: Corner, position: Vec3, normal: Vec3) -> u32 {
        let texcoord = self
            .texcoords
            .get(corner.texcoord as usize)
            .copied()
            .unwrap_or(Vec2::ZERO);
        let texcoord = if texcoord.is_finite() {
            texcoord
        } else {
            Vec2::ZERO
        };
        scene.positions.push(position.to_array());
        scene.normals.push(normal.to_array());
        // OBJ counts v upward from the lowest row of the picture, Vulkan downward from the highest.
        scene.texcoords.push([texcoord.x, 1.0 - texcoord.y]);
        (scene.positions.len() - 1) as u32
    }
}

/// Unit normal of a counter-clockwise triangle, or none if it has no area to speak of.
fn face_normal(corners: [Vec3; 3]) -> Option<Vec3> {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let cross = (b - a).cross(c - a);
    let longest = (b - a)
        .length_squared()
        .max((c - a).length_squared())
        .max((c - b).length_squared());
    // Positions have 24 bits: a height below 1e-10 of the longest edge is rounding.
    (cross.length() > 1e-10 * longest).then(|| cross.normalize().as_vec3())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(points: [Vec3; 3], normal: Vec3) -> Soup {
        let corner = |position| Corner {
            position,
            texcoord: NONE,
            normal: 0,
        };
        Soup {
            positions: points.to_vec(),
            normals: vec![normal],
            triangles: vec![Triangle {
                corners: [0, 1, 2].map(corner),
                material: 0,
                smoothing: 0,
            }],
            ..Soup::default()
        }
    }

    #[test]
    fn mirrored_meshes_keep_winding_and_normals_together() {
        let mut soup = one([Vec3::ZERO, Vec3::X, Vec3::Y], Vec3::Z);
        soup.transform(&Affine3A::from_scale(Vec3::new(1.0, 1.0, -2.0)));
        let (dropped, faces) = soup.sweep();
        assert_eq!(dropped, Dropped::default());
        assert_eq!(faces, [Vec3::NEG_Z]);
        assert_eq!(soup.normal(soup.triangles[0].corners[0]), Some(Vec3::NEG_Z));
    }

    #[test]
    fn normals_follow_the_inverse_transpose() {
        let slope = Vec3::new(1.0, 1.0, 0.0).normalize();
        let mut soup = one([Vec3::X, Vec3::Y, Vec3::new(0.5, 0.5, 1.0)], slope);
        soup.transform(&Affine3A::from_scale(Vec3::new(4.0, 1.0, 1.0)));
        let (_, faces) = soup.sweep();
        let normal = soup.normal(soup.triangles[0].corners[0]).expect("a normal");
        assert!(
            normal.dot(faces[0]).abs() > 0.99999,
            "{normal} {}",
            faces[0]
        );
    }

    #[test]
    fn unusable_triangles_are_counted() {
        for (points, expected) in [
            ([Vec3::ZERO, Vec3::X, Vec3::NAN], (1, 0)),
            ([Vec3::ZERO, Vec3::X, Vec3::splat(3e38)], (1, 0)),
            ([Vec3::ZERO, Vec3::X, Vec3::X * 2.0], (0, 1)),
            ([Vec3::ONE; 3], (0, 1)),
            ([Vec3::ZERO, Vec3::X * 1e-6, Vec3::Y * 1e-6], (0, 0)),
        ] {
            let (dropped, _) = one(points, Vec3::Z).sweep();
            assert_eq!(
                (dropped.not_finite, dropped.degenerate),
                expected,
                "{points:?}"
            );
        }
    }

    #[test]
    fn equal_corners_become_one_vertex() {
        let mut soup = one([Vec3::ZERO, Vec3::X, Vec3::Y], Vec3::ZERO);
        soup.triangles.push(soup.triangles[0]);
        let (_, faces) = soup.sweep();
        let mut scene = Scene::default();
        assert!(soup.append_to(&mut scene, &faces, None));
        assert_eq!(
            (
                scene.positions.len(),
                scene.indices.len(),
                scene.parts.len()
            ),
            (3, 6, 1)
        );
        assert_eq!(
            scene.normals[0],
            [0.0, 0.0, 1.0],
            "a zero normal is replaced by the face's"
        );
        assert_eq!(scene.texcoords[0], [0.0, 1.0]);
    }
}
