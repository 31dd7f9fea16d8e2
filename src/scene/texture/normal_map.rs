//! Normal maps: tangents, and conversion from height maps.

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::Vec3;

/// Triangle corners in the form MikkTSpace expects, three per triangle.
#[derive(Debug, Default)]
pub struct TangentInput {
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    pub texcoords: Vec<[f32; 2]>,
    /// Output: unit tangent and the sign of the bitangent.
    pub tangents: Vec<[f32; 4]>,
}

impl TangentInput {
    /// Tangents as in Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited", which normal map bakers also use.
    pub fn compute_tangents(&mut self) {
        self.tangents = vec![[0.0; 4]; self.positions.len()];
        // Fails only if there are no faces.
        let _ = generate_tangents(self);
        for (tangent, normal) in self.tangents.iter_mut().zip(&self.normals) {
            *tangent = usable_tangent(*tangent, Vec3::from(*normal));
        }
    }
}

/// A unit tangent perpendicular to `normal`, and the sign of the bitangent; an arbitrary tangent if the given one is unusable.
pub fn usable_tangent([x, y, z, w]: [f32; 4], normal: Vec3) -> [f32; 4] {
    let given = Vec3::new(x, y, z);
    let flat = given - normal * normal.dot(given);
    let unit = if flat.is_finite() && flat.length_squared() > 1e-8 {
        flat.normalize()
    } else {
        normal.any_orthonormal_vector()
    };
    unit.extend(if w < 0.0 { -1.0 } else { 1.0 }).to_array()
}

impl Geometry for TangentInput {
    fn num_faces(&self) -> usize {
        self.positions.len() / 3
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.positions[3 * face + corner]
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.normals[3 * face + corner]
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.texcoords[3 * face + corner]
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        if let Some(space) = space {
            self.tangents[3 * face + corner] = space.tangent_encoded();
        }
    }
}

/// Whether an image (RGBA) is a height map, that is, grey everywhere. Normal maps are bluish.
pub fn is_height_field(rgba8: &[u8]) -> bool {
    rgba8
        .chunks_exact(4)
        .all(|t| t[0].abs_diff(t[1]) <= 2 && t[1].abs_diff(t[2]) <= 2)
}

/// The normal map of a repeating height map (RGBA, grey) in which white is `strength` texels high.
pub fn normals_from_heights(rgba8: &[u8], width: u32, height: u32, strength: f32) -> Vec<u8> {
    let (w, h) = (width as usize, height as usize);
    let at = |x: usize, y: usize| f32::from(rgba8[4 * (y % h * w + x % w)]) / 255.0 * strength;
    let mut normals = Vec::with_capacity(rgba8.len());
    for y in 0..h {
        for x in 0..w {
            let slope_x = 0.5 * (at(x + 1, y) - at(x + w - 1, y));
            // Rows run down; the green channel points up.
            let slope_y = 0.5 * (at(x, y + h - 1) - at(x, y + 1));
            let n = Vec3::new(-slope_x, -slope_y, 1.0).normalize();
            let byte = |v: f32| ((0.5 * v + 0.5) * 255.0).round() as u8;
            normals.extend([byte(n.x), byte(n.y), byte(n.z), 255]);
        }
    }
    normals
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tangents_follow_the_texture() {
        // A square on the floor with u running along -z.
        let mut corners = TangentInput {
            positions: vec![[0.0; 3], [0.0, 0.0, -1.0], [-1.0, 0.0, -1.0]],
            normals: vec![[0.0, 1.0, 0.0]; 3],
            texcoords: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]],
            tangents: Vec::new(),
        };
        corners.compute_tangents();
        for [x, y, z, w] in &corners.tangents {
            assert!(x.abs() < 1e-6 && y.abs() < 1e-6 && (z + 1.0).abs() < 1e-6);
            assert_eq!(w.abs(), 1.0);
        }
    }

    #[test]
    fn unusable_tangents_are_replaced() {
        for bad in [[0.0; 4], [f32::NAN; 4], [0.0, 3.0, 0.0, -1.0]] {
            let [x, y, z, _] = usable_tangent(bad, Vec3::Y);
            let t = Vec3::new(x, y, z);
            assert!((t.length() - 1.0).abs() < 1e-6 && t.dot(Vec3::Y).abs() < 1e-6);
        }
    }

    #[test]
    fn a_ramp_leans_against_its_rise() {
        // Heights rise to the right by one texel per texel: the normal tilts left by 45 degrees.
        let ramp: Vec<u8> = (0..16).flat_map(|i| [(i % 4) * 85; 4]).collect();
        assert!(is_height_field(&ramp));
        let normals = normals_from_heights(&ramp, 4, 4, 3.0);
        let at =
            |x: usize| Vec3::from([0, 1, 2].map(|i| f32::from(normals[4 * x + i]) / 127.5 - 1.0));
        let expected = Vec3::new(-1.0, 0.0, 1.0).normalize();
        assert!((at(1) - expected).length() < 0.02, "{}", at(1));
        let flat = normals_from_heights(&[77; 64], 4, 4, 9.0);
        assert_eq!(flat[..3], [128, 128, 255]);
    }
}
