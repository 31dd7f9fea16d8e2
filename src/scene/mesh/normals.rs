//! Normals of corners that have none in the file: flat, by smoothing group, or by crease angle.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use crate::scene::mesh::soup::{NONE, Soup, Triangle};

/// Maximum number of corners at one position that are compared pairwise. Beyond it they stay flat; this bounds the time for
/// malicious files.
const MAX_COMPARED: usize = 512;

/// Computes one unit normal per triangle corner.
///
/// The file's normal if it is usable. Otherwise the face normal, averaged over the faces around the position that are within
/// `smooth_deg` degrees if given, or in the same smoothing group. `face_normals` holds one unit vector per triangle.
pub fn corner_normals(
    soup: &Soup,
    face_normals: &[Vec3],
    smooth_deg: Option<f32>,
) -> Vec<[Vec3; 3]> {
    let mut normals: Vec<[Vec3; 3]> = soup
        .triangles
        .iter()
        .zip(face_normals)
        .map(|(triangle, face)| triangle.corners.map(|c| soup.normal(c).unwrap_or(*face)))
        .collect();
    let open: Vec<Corner> = missing_corners(soup, smooth_deg.is_some());
    if open.is_empty() {
        return normals;
    }
    let points = weld(soup, &open);
    match smooth_deg {
        Some(degrees) => by_crease(&points, face_normals, degrees, &mut normals),
        None => by_group(soup, &points, face_normals, &mut normals),
    }
    normals
}

/// A corner that needs a smooth normal.
#[derive(Debug, Clone, Copy)]
struct Corner {
    triangle: u32,
    corner: u8,
    /// Angle of the triangle at this corner, radians: the weight of its face normal.
    angle: f32,
}

fn missing_corners(soup: &Soup, all: bool) -> Vec<Corner> {
    let wants = |t: &Triangle| all || t.smoothing != 0;
    let mut open = Vec::new();
    for (i, triangle) in soup.triangles.iter().enumerate().filter(|(_, t)| wants(t)) {
        for corner in (0..3u8).filter(|&c| triangle.corners[usize::from(c)].normal == NONE) {
            let angle = angle_at(soup, triangle, usize::from(corner));
            open.push(Corner {
                triangle: i as u32,
                corner,
                angle,
            });
        }
    }
    open
}

fn angle_at(soup: &Soup, triangle: &Triangle, corner: usize) -> f32 {
    let at = |i: usize| soup.position(triangle.corners[(corner + i) % 3]).as_dvec3();
    let (a, b): (DVec3, DVec3) = (at(1) - at(0), at(2) - at(0));
    let angle = a.angle_between(b) as f32;
    if angle.is_finite() { angle } else { 0.0 }
}

/// Groups corners by position, regardless of the position's index in the file.
fn weld(soup: &Soup, open: &[Corner]) -> Vec<Vec<Corner>> {
    let mut index: HashMap<[u32; 3], usize> = HashMap::new();
    let mut points: Vec<Vec<Corner>> = Vec::new();
    for corner in open {
        let triangle = &soup.triangles[corner.triangle as usize];
        // Adding zero normalises −0 to 0.
        let position = soup.position(triangle.corners[usize::from(corner.corner)]) + 0.0;
        let key = position.to_array().map(f32::to_bits);
        let at = *index.entry(key).or_insert_with(|| {
            points.push(Vec::new());
            points.len() - 1
        });
        points[at].push(*corner);
    }
    points
}

fn by_group(soup: &Soup, points: &[Vec<Corner>], faces: &[Vec3], normals: &mut [[Vec3; 3]]) {
    let group = |c: &Corner| soup.triangles[c.triangle as usize].smoothing;
    for around in points {
        let mut sums: HashMap<u32, Vec3> = HashMap::new();
        for c in around {
            *sums.entry(group(c)).or_default() += c.angle * faces[c.triangle as usize];
        }
        for c in around {
            let face = faces[c.triangle as usize];
            let sum = sums.get(&group(c)).copied().unwrap_or(face);
            normals[c.triangle as usize][usize::from(c.corner)] = sum.normalize_or(face);
        }
    }
}

fn by_crease(points: &[Vec<Corner>], faces: &[Vec3], degrees: f32, normals: &mut [[Vec3; 3]]) {
    // With a tolerance, so that 30 degrees smooths a twelve-sided prism.
    let limit = (degrees + 0.01).min(180.0).to_radians().cos();
    for around in points.iter().filter(|around| around.len() <= MAX_COMPARED) {
        for c in around {
            let face = faces[c.triangle as usize];
            let near = |other: &&Corner| faces[other.triangle as usize].dot(face) >= limit;
            let sum: Vec3 = around
                .iter()
                .filter(near)
                .map(|o| o.angle * faces[o.triangle as usize])
                .sum();
            normals[c.triangle as usize][usize::from(c.corner)] = sum.normalize_or(face);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::mesh::soup::Corner as SoupCorner;

    /// Two unit squares that meet at a right angle along the x axis: a floor and a wall.
    fn corner_of_a_room(smoothing: [u32; 2]) -> Soup {
        let quads = [
            [Vec3::ZERO, Vec3::Z, Vec3::new(1.0, 0.0, 1.0), Vec3::X],
            [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y],
        ];
        let mut soup = Soup::default();
        for (quad, smoothing) in quads.iter().zip(smoothing) {
            let first = soup.positions.len() as u32;
            soup.positions.extend_from_slice(quad);
            for corners in [[0, 1, 2], [0, 2, 3]] {
                let corner = |i: u32| SoupCorner {
                    position: first + i,
                    texcoord: NONE,
                    normal: NONE,
                };
                soup.triangles.push(Triangle {
                    corners: corners.map(corner),
                    material: 0,
                    smoothing,
                });
            }
        }
        soup
    }

    fn normals(smoothing: [u32; 2], smooth: Option<f32>) -> Vec<[Vec3; 3]> {
        let soup = corner_of_a_room(smoothing);
        corner_normals(&soup, &[Vec3::Y, Vec3::Y, Vec3::Z, Vec3::Z], smooth)
    }

    #[test]
    fn without_groups_faces_are_flat() {
        let normals = normals([0, 0], None);
        assert_eq!(normals[0], [Vec3::Y; 3]);
        assert_eq!(normals[3], [Vec3::Z; 3]);
    }

    #[test]
    fn one_group_bends_over_the_edge_and_two_do_not() {
        let middle = Vec3::new(0.0, 1.0, 1.0).normalize();
        let bent = normals([1, 1], None);
        assert!((bent[0][0] - middle).length() < 1e-6, "{}", bent[0][0]);
        assert!((bent[0][1] - Vec3::Y).length() < 1e-6, "away from the edge");
        assert_eq!(normals([1, 2], None)[0][0], Vec3::Y);
    }

    #[test]
    fn the_crease_angle_decides() {
        assert_eq!(normals([0, 0], Some(89.0))[0][0], Vec3::Y);
        let bent = normals([0, 0], Some(90.0))[0][0];
        assert!(
            (bent - Vec3::new(0.0, 1.0, 1.0).normalize()).length() < 1e-6,
            "{bent}"
        );
        assert_eq!(
            normals([1, 1], Some(30.0))[0][0],
            Vec3::Y,
            "the angle overrides the group"
        );
    }
}
