//! A triangle soup: the triangles of one mesh between file and arena, with separate indices for positions, texture coordinates
//! and normals.

use glam::{Affine2, Affine3A, Mat3, Vec2, Vec3};

use crate::scene::mesh::triangulate::Triangulator;

/// "No index" in a [`Corner`] or a [`MaterialUse`].
pub const NONE: u32 = u32::MAX;

/// Triangles with larger coordinates (metres) are dropped: their squares and sums would overflow `f32`.
const MAX_COORDINATE: f32 = 1e9;

/// One corner of a triangle: indices into the lists of [`Soup`], or [`NONE`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    pub position: u32,
    pub texcoord: u32,
    pub normal: u32,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle {
    pub corners: [Corner; 3],
    /// Index of the material in the mesh.
    pub material: u32,
    /// Smoothing group; 0 for none.
    pub smoothing: u32,
}

/// A face with more than three corners, flat or nearly so.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    /// End of its corners in [`Polygons::corners`]; they start where the previous polygon ends.
    end: usize,
    material: u32,
    smoothing: u32,
}

#[derive(Debug, Default, Clone, PartialEq)]
pub struct Polygons {
    corners: Vec<Corner>,
    list: Vec<Polygon>,
}

/// How a mesh uses a material of the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaterialUse {
    /// Index in [`Scene::materials`](crate::scene::Scene::materials), or [`NONE`] if it is not drawn.
    pub index: u32,
    /// Maps texture coordinates of the mesh to those of the textures; v has the same direction as in the mesh.
    pub texture_from_mesh: Affine2,
    /// Whether it has a normal map, which requires tangents.
    pub has_normal_map: bool,
}

impl MaterialUse {
    /// A material without a normal map or texture transform.
    pub fn plain(index: u32) -> Self {
        Self {
            index,
            texture_from_mesh: Affine2::IDENTITY,
            has_normal_map: false,
        }
    }
}

/// The triangles of one mesh.
#[derive(Debug, Default)]
pub struct Soup {
    pub positions: Vec<Vec3>,
    /// Linear RGBA factors on ρ_d and opacity, one per position; positions beyond the end are white.
    pub colours: Vec<[f32; 4]>,
    pub texcoords: Vec<Vec2>,
    pub normals: Vec<Vec3>,
    pub triangles: Vec<Triangle>,
    /// Empty after [`Soup::triangulate`].
    pub polygons: Polygons,
}

/// Number of triangles dropped as unusable.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub struct Dropped {
    pub not_finite: usize,
    pub degenerate: usize,
}

impl Dropped {
    pub fn add(&mut self, more: Self) {
        self.not_finite += more.not_finite;
        self.degenerate += more.degenerate;
    }
}

impl Soup {
    pub fn position(&self, corner: Corner) -> Vec3 {
        self.positions[corner.position as usize]
    }

    /// Unit normal of a corner from the file; `None` if it is missing, zero or not finite.
    pub fn normal(&self, corner: Corner) -> Option<Vec3> {
        let normal = self.normals.get(corner.normal as usize)?;
        normal.is_finite().then(|| normal.try_normalize()).flatten()
    }

    /// Texture coordinate of a corner from the file; (0, 0) if it is missing or not finite.
    pub fn texcoord(&self, corner: Corner) -> Vec2 {
        let texcoord = self.texcoords.get(corner.texcoord as usize).copied();
        texcoord.filter(|t| t.is_finite()).unwrap_or(Vec2::ZERO)
    }

    /// Colour of a position; white if it has none.
    pub fn colour_of(&self, position: u32) -> [f32; 4] {
        let colour = self.colours.get(position as usize).copied();
        colour.unwrap_or([1.0; 4])
    }

    /// Adds a face with more than three corners.
    pub fn push_polygon(
        &mut self,
        corners: impl Iterator<Item = Corner>,
        material: u32,
        smoothing: u32,
    ) {
        self.polygons.corners.extend(corners);
        self.polygons.list.push(Polygon {
            end: self.polygons.corners.len(),
            material,
            smoothing,
        });
    }

    /// Appends the next chunk of the same file; `material` maps its material indices. Corner indices are relative to the start
    /// of the file.
    pub fn append(&mut self, mut next: Self, material: impl Fn(u32) -> u32) {
        if !next.colours.is_empty() {
            self.colours.resize(self.positions.len(), [1.0; 4]);
            self.colours.append(&mut next.colours);
        }
        for m in next.triangles.iter_mut().map(|t| &mut t.material) {
            *m = material(*m);
        }
        if self.positions.is_empty() && self.triangles.is_empty() {
            // The first chunk is moved instead of copied.
            (self.positions, self.triangles) = (next.positions, next.triangles);
            (self.texcoords, self.normals) = (next.texcoords, next.normals);
        } else {
            self.positions.append(&mut next.positions);
            self.triangles.append(&mut next.triangles);
            self.texcoords.append(&mut next.texcoords);
            self.normals.append(&mut next.normals);
        }
        let before = self.polygons.corners.len();
        self.polygons.corners.append(&mut next.polygons.corners);
        let list = next.polygons.list.into_iter();
        self.polygons.list.extend(list.map(|p| Polygon {
            end: before + p.end,
            material: material(p.material),
            smoothing: p.smoothing,
        }));
    }

    /// Number of triangles after splitting the polygons.
    pub fn count(&self) -> usize {
        let polygons = &self.polygons;
        // Each polygon has at least three corners.
        self.triangles.len() + polygons.corners.len() - 2 * polygons.list.len()
    }

    /// Splits the polygons into triangles.
    pub fn triangulate(&mut self) {
        let polygons = std::mem::take(&mut self.polygons);
        let mut triangulator = Triangulator::for_corners(polygons.corners.len());
        let mut start = 0;
        for polygon in &polygons.list {
            let corners = &polygons.corners[start..polygon.end];
            start = polygon.end;
            let points: Vec<_> = corners
                .iter()
                .map(|c| self.position(*c).as_dvec3())
                .collect();
            let triangles = triangulator.triangulate(&points);
            self.triangles
                .extend(triangles.into_iter().map(|t| Triangle {
                    corners: t.map(|i| corners[i]),
                    material: polygon.material,
                    smoothing: polygon.smoothing,
                }));
        }
    }

    /// Transforms everything to world space. A mirroring transform also reverses the winding, to keep it consistent with the
    /// normals.
    pub fn transform(&mut self, world_from_mesh: &Affine3A) {
        if *world_from_mesh == Affine3A::IDENTITY {
            return;
        }
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

    /// Drops degenerate triangles and those with unusable positions; returns their counts and the unit face normals of the
    /// rest.
    pub fn drop_unusable(&mut self) -> (Dropped, Vec<Vec3>) {
        let mut dropped = Dropped::default();
        let mut faces = Vec::with_capacity(self.triangles.len());
        let positions = &self.positions;
        self.triangles.retain(|triangle| {
            let corners = triangle.corners.map(|c| positions[c.position as usize]);
            match usable_face(corners, &mut dropped) {
                Some(face) => faces.push(face),
                None => return false,
            }
            true
        });
        (dropped, faces)
    }
}

/// Unit normal of a triangle if it is usable; otherwise counts it in `dropped`.
pub fn usable_face(corners: [Vec3; 3], dropped: &mut Dropped) -> Option<Vec3> {
    let usable = |p: Vec3| p.is_finite() && p.abs().max_element() <= MAX_COORDINATE;
    if !corners.into_iter().all(usable) {
        dropped.not_finite += 1;
        return None;
    }
    let face = face_normal(corners);
    dropped.degenerate += usize::from(face.is_none());
    face
}

/// Unit normal of a counter-clockwise triangle; `None` if its area is zero within rounding.
fn face_normal(corners: [Vec3; 3]) -> Option<Vec3> {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let cross = (b - a).cross(c - a);
    let longest = (b - a)
        .length_squared()
        .max((c - a).length_squared())
        .max((c - b).length_squared());
    // Positions have 24 significant bits: a height below 1e-10 of the longest edge is rounding error.
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
        let (dropped, faces) = soup.drop_unusable();
        assert_eq!(dropped, Dropped::default());
        assert_eq!(faces, [Vec3::NEG_Z]);
        assert_eq!(soup.normal(soup.triangles[0].corners[0]), Some(Vec3::NEG_Z));
    }

    #[test]
    fn normals_follow_the_inverse_transpose() {
        let slope = Vec3::new(1.0, 1.0, 0.0).normalize();
        let mut soup = one([Vec3::X, Vec3::Y, Vec3::new(0.5, 0.5, 1.0)], slope);
        soup.transform(&Affine3A::from_scale(Vec3::new(4.0, 1.0, 1.0)));
        let (_, faces) = soup.drop_unusable();
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
            let (dropped, _) = one(points, Vec3::Z).drop_unusable();
            assert_eq!(
                (dropped.not_finite, dropped.degenerate),
                expected,
                "{points:?}"
            );
        }
    }
}
