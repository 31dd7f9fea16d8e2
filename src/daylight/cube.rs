//! Cube maps: Vulkan's face convention, texel directions and solid angles, and a cube map on the CPU.
//!
//! Faces are layers +X -X +Y -Y +Z -Z. (s, t) are in 0..=1 on a face, t downward, as in the Vulkan specification, "Cube Map
//! Face Selection". The lecture's faces "left, right, top, bottom, front, back" are the same six in another order. Its
//! `2 i / res - 1` is a texel's corner; here texel centres are at (i + ½)/N.

use glam::DVec3;

/// Number of faces.
pub const FACES: usize = 6;

/// Direction (not normalised; its largest component is ±1) through (`s`, `t`) of `face` (0..6, Vulkan's layer order).
///
/// Vulkan 1.3, table "Cube map face and coordinate selection", solved for the direction.
pub fn face_vector(face: usize, s: f64, t: f64) -> DVec3 {
    let (u, v) = (2.0 * s - 1.0, 2.0 * t - 1.0);
    match face {
        0 => DVec3::new(1.0, -v, -u),
        1 => DVec3::new(-1.0, -v, u),
        2 => DVec3::new(u, 1.0, v),
        3 => DVec3::new(u, -1.0, -v),
        4 => DVec3::new(u, -v, 1.0),
        _ => DVec3::new(-u, -v, -1.0),
    }
}

/// Unit direction through (`s`, `t`) of `face`.
pub fn direction(face: usize, s: f64, t: f64) -> DVec3 {
    face_vector(face, s, t).normalize()
}

/// Unit direction through the centre of texel (`i`, `j`) (column, row) of `face` with `size` texels along an edge.
pub fn texel_direction(face: usize, i: usize, j: usize, size: usize) -> DVec3 {
    let n = size as f64;
    direction(face, (i as f64 + 0.5) / n, (j as f64 + 0.5) / n)
}

/// (face, s, t) of a direction; Vulkan 1.3, "Cube Map Face Selection"; ties go to z, then y, then x.
pub fn face_of(direction: DVec3) -> (usize, f64, f64) {
    let DVec3 { x, y, z } = direction;
    let a = direction.abs();
    let (face, s, t, major) = if a.z >= a.x && a.z >= a.y {
        if z >= 0.0 {
            (4, x, -y, a.z)
        } else {
            (5, -x, -y, a.z)
        }
    } else if a.y >= a.x {
        if y >= 0.0 {
            (2, x, z, a.y)
        } else {
            (3, x, -z, a.y)
        }
    } else if x >= 0.0 {
        (0, -z, -y, a.x)
    } else {
        (1, z, -y, a.x)
    };
    (face, 0.5 * (s / major + 1.0), 0.5 * (t / major + 1.0))
}

/// Solid angle of texel (`i`, `j`) of a face with `size` texels along an edge, sr; exact. The sum over all faces is 4π.
pub fn texel_solid_angle(i: usize, j: usize, size: usize) -> f64 {
    let edge = |k: usize| 2.0 * k as f64 / size as f64 - 1.0;
    let corner = |x: f64, y: f64| (x * y).atan2((x * x + y * y + 1.0).sqrt());
    let (x0, x1, y0, y1) = (edge(i), edge(i + 1), edge(j), edge(j + 1));
    corner(x0, y0) - corner(x0, y1) - corner(x1, y0) + corner(x1, y1)
}

/// Unit directions of the four corners of texel (`i`, `j`), in cyclic order.
pub fn texel_corners(face: usize, i: usize, j: usize, size: usize) -> [DVec3; 4] {
    let n = size as f64;
    [(0, 0), (1, 0), (1, 1), (0, 1)]
        .map(|(a, b)| direction(face, (i + a) as f64 / n, (j + b) as f64 / n))
}

/// A cube map on the CPU: six faces, rows from t = 0, linear RGB in f64.
#[derive(Clone, Debug, PartialEq)]
pub struct CubeMap {
    size: usize,
    texels: Vec<DVec3>,
}

impl CubeMap {
    /// A map with `size` texels per edge; each texel is `f` of the unit direction through its centre.
    pub fn from_fn(size: usize, f: impl Fn(DVec3) -> DVec3) -> Self {
        let texels = texels(size)
            .map(|(face, i, j)| f(texel_direction(face, i, j, size)))
            .collect();
        Self { size, texels }
    }

    /// A map with `size` texels per edge from its texels in memory order: face by face, row by row.
    ///
    /// # Panics
    /// Unless there are 6 `size`² of them.
    pub fn from_texels(size: usize, texels: Vec<DVec3>) -> Self {
        assert_eq!(texels.len(), FACES * size * size, "texels of a cube");
        Self { size, texels }
    }

    /// Texels along an edge.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Texel at column `i`, row `j` of `face`.
    pub fn texel(&self, face: usize, i: usize, j: usize) -> DVec3 {
        self.texels[(face * self.size + j) * self.size + i]
    }

    /// All texels with (face, column, row), in memory order.
    pub fn iter(&self) -> impl Iterator<Item = ((usize, usize, usize), DVec3)> + '_ {
        texels(self.size).zip(self.texels.iter().copied())
    }

    /// The map at half the resolution: each texel is the mean of four, weighted by solid angle.
    pub fn halved(&self) -> Self {
        let size = self.size / 2;
        let mean = |(face, i, j): (usize, usize, usize)| {
            let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(a, b)| (2 * i + a, 2 * j + b));
            let weight = |(i, j)| texel_solid_angle(i, j, self.size);
            let sum: DVec3 = four
                .iter()
                .map(|&(i, j)| self.texel(face, i, j) * weight((i, j)))
                .sum();
            sum / four.iter().map(|&c| weight(c)).sum::<f64>()
        };
        Self {
            size,
            texels: texels(size).map(mean).collect(),
        }
    }

    /// Bilinear lookup in a direction, like a seamless cube-map sampler (except at three-texel corners).
    pub fn bilinear(&self, direction: DVec3) -> DVec3 {
        let (face, s, t) = face_of(direction);
        let size = self.size as f64;
        let (x, y) = (s * size - 0.5, t * size - 0.5);
        let (u, v) = (x - x.floor(), y - y.floor());
        let at = |a: f64, b: f64| self.across(face, x.floor() + a, y.floor() + b);
        at(0.0, 0.0)
            .lerp(at(1.0, 0.0), u)
            .lerp(at(0.0, 1.0).lerp(at(1.0, 1.0), u), v)
    }

    /// The texel in column `i`, row `j`; one step beyond the face's edge it is a texel of the neighbouring face.
    fn across(&self, face: usize, i: f64, j: f64) -> DVec3 {
        let size = self.size as f64;
        self.nearest(face_vector(face, (i + 0.5) / size, (j + 0.5) / size))
    }

    /// Nearest texel in a direction (any length except zero).
    pub fn nearest(&self, direction: DVec3) -> DVec3 {
        let (face, s, t) = face_of(direction);
        // s and t lie in 0..=1; the cast truncates.
        let index = |x: f64| ((x * self.size as f64) as usize).min(self.size - 1);
        self.texel(face, index(s), index(t))
    }
}

/// (face, column, row) of every texel, in memory order.
pub fn texels(size: usize) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..FACES * size * size).map(move |k| (k / (size * size), k % size, k / size % size))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn bilinear_lookups_are_seamless_and_exact_at_centres() {
        let map = CubeMap::from_fn(16, |d| d + DVec3::ONE);
        for (face, i, j) in texels(16) {
            let centre = texel_direction(face, i, j, 16);
            assert!((map.bilinear(centre) - map.texel(face, i, j)).length() < 1e-12);
        }
        for k in 0..100 {
            // Along the edge between +X and +Z.
            let edge = DVec3::new(1.0, f64::from(k) / 60.0 - 0.8, 1.0).normalize();
            let error = (map.bilinear(edge) - (edge + DVec3::ONE)).length();
            assert!(error < 0.02, "{edge}: {error}");
        }
    }

    #[test]
    fn halving_keeps_the_integral() {
        let map = CubeMap::from_fn(32, |d| DVec3::new(1.0, d.y.max(0.0), d.x * d.x));
        let integral = |map: &CubeMap| -> DVec3 {
            map.iter()
                .map(|((_, i, j), c)| c * texel_solid_angle(i, j, map.size()))
                .sum()
        };
        assert!((integral(&map) - integral(&map.halved())).length() < 1e-12);
    }

    #[test]
    fn face_centres_are_the_axes() {
        let axes = [
            DVec3::X,
            DVec3::NEG_X,
            DVec3::Y,
            DVec3::NEG_Y,
            DVec3::Z,
            DVec3::NEG_Z,
        ];
        for (face, axis) in axes.into_iter().enumerate() {
            assert_eq!(direction(face, 0.5, 0.5), axis);
        }
    }

    #[test]
    fn vulkans_table_is_met() {
        // Rows of the specification's table: s_c and t_c for each major axis, at one direction per face.
        let rows = [
            (DVec3::new(1.0, 0.2, 0.3), 0, -0.3, -0.2),
            (DVec3::new(-1.0, 0.2, 0.3), 1, 0.3, -0.2),
            (DVec3::new(0.2, 1.0, 0.3), 2, 0.2, 0.3),
            (DVec3::new(0.2, -1.0, 0.3), 3, 0.2, -0.3),
            (DVec3::new(0.2, 0.3, 1.0), 4, 0.2, -0.3),
            (DVec3::new(0.2, 0.3, -1.0), 5, -0.2, -0.3),
        ];
        for (dir, face, sc, tc) in rows {
            let (found, s, t) = face_of(dir);
            assert_eq!(found, face);
            assert!((s - 0.5 * (sc + 1.0)).abs() < 1e-15 && (t - 0.5 * (tc + 1.0)).abs() < 1e-15);
        }
    }

    #[test]
    fn direction_and_face_are_inverse() {
        for (face, i, j) in texels(16) {
            let (found, s, t) = face_of(texel_direction(face, i, j, 16));
            assert_eq!(found, face);
            let (si, tj) = ((i as f64 + 0.5) / 16.0, (j as f64 + 0.5) / 16.0);
            assert!((s - si).abs() < 1e-14 && (t - tj).abs() < 1e-14);
        }
    }

    #[test]
    fn solid_angles_fill_the_sphere() {
        for size in [1, 2, 7, 64] {
            let sum: f64 = texels(size)
                .map(|(_, i, j)| texel_solid_angle(i, j, size))
                .sum();
            assert!((sum - 4.0 * PI).abs() < 1e-11, "{size} {sum}");
        }
    }

    #[test]
    fn texels_come_back_where_they_were_written() {
        let map = CubeMap::from_fn(8, |dir| dir);
        for ((face, i, j), value) in map.iter() {
            assert_eq!(map.texel(face, i, j), value);
            assert_eq!(map.nearest(value), value);
        }
    }
}
