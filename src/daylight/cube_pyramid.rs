//! A cube map with its mip levels on the CPU, looked up as a device's sampler does: trilinear, seamless across the faces.

use glam::{DVec3, Vec3};

use super::cube::{self, CubeMap, FACES, face_of, face_vector};

/// A cube map and all its halvings, linear RGB in `f32`.
pub struct CubePyramid {
    levels: Vec<Level>,
}

/// One level. Each face has a border of the neighbouring faces' texels, so that no lookup leaves its face.
struct Level {
    size: usize,
    texels: Vec<Vec3>,
}

impl CubePyramid {
    /// The levels of `map`, halved while the edge is even. Each texel is the mean of four, weighted by solid angle.
    pub fn new(map: CubeMap) -> Self {
        let mut levels = vec![Level::new(&map)];
        let mut map = map;
        while map.size().is_multiple_of(2) {
            map = map.halved();
            levels.push(Level::new(&map));
        }
        Self { levels }
    }

    /// Number of levels.
    pub fn levels(&self) -> usize {
        self.levels.len()
    }

    /// Texels along an edge of level 0.
    pub fn edge(&self) -> u32 {
        self.levels[0].size as u32
    }

    /// The texels of a level, face by face and row by row.
    pub fn texels(&self, level: usize) -> impl Iterator<Item = Vec3> + '_ {
        let level = &self.levels[level];
        cube::texels(level.size).map(|(face, i, j)| level.texels[level.index(face, i + 1, j + 1)])
    }

    /// Trilinear lookup in a unit direction; `level` may have a fraction.
    pub fn trilinear(&self, direction: DVec3, level: f64) -> Vec3 {
        let (face, s, t) = face_of(direction);
        let (lower, blend) = (level.max(0.0).floor() as usize, level.max(0.0).fract());
        let last = self.levels.len() - 1;
        let at = |level: usize| self.levels[level.min(last)].bilinear(face, s, t);
        if blend > 0.0 {
            at(lower).lerp(at(lower + 1), blend as f32)
        } else {
            at(lower)
        }
    }
}

impl Level {
    fn new(map: &CubeMap) -> Self {
        let size = map.size();
        let mut texels = Vec::with_capacity(FACES * (size + 2) * (size + 2));
        for face in 0..FACES {
            for (j, i) in (0..size + 2).flat_map(|j| (0..size + 2).map(move |i| (j, i))) {
                texels.push(bordered(map, face, i, j).as_vec3());
            }
        }
        Self { size, texels }
    }

    /// Of the texel in column `i`, row `j` of a face with its border.
    fn index(&self, face: usize, i: usize, j: usize) -> usize {
        let stride = self.size + 2;
        (face * stride + j) * stride + i
    }

    fn bilinear(&self, face: usize, s: f64, t: f64) -> Vec3 {
        let size = self.size as f64;
        // Texel 0 is the border. s and t are in 0..=1, so that the casts truncate numbers that are not negative.
        let (x, y) = (s * size + 0.5, t * size + 0.5);
        let (i, j) = ((x as usize).min(self.size), (y as usize).min(self.size));
        let (u, v) = ((x - i as f64) as f32, (y - j as f64) as f32);
        let (above, below) = (self.index(face, i, j), self.index(face, i, j + 1));
        let row = |at: usize| self.texels[at].lerp(self.texels[at + 1], u);
        row(above).lerp(row(below), v)
    }
}

/// The texel in column `i`, row `j` of a face with its border. At a cube's corner, where three texels meet, it is their mean.
fn bordered(map: &CubeMap, face: usize, i: usize, j: usize) -> DVec3 {
    let size = map.size();
    let is_out = |k: usize| k == 0 || k == size + 1;
    let inner = |k: usize| k.clamp(1, size) - 1;
    match (is_out(i), is_out(j)) {
        (false, false) => map.texel(face, i - 1, j - 1),
        (true, true) => {
            let three =
                [(inner(i) + 1, j), (i, inner(j) + 1)].map(|(i, j)| across(map, face, i, j));
            (three[0] + three[1] + map.texel(face, inner(i), inner(j))) / 3.0
        }
        _ => across(map, face, i, j),
    }
}

/// The texel of the neighbouring face beside the texel in column `i`, row `j`, counted with the border.
fn across(map: &CubeMap, face: usize, i: usize, j: usize) -> DVec3 {
    let size = map.size() as f64;
    map.nearest(face_vector(
        face,
        (i as f64 - 0.5) / size,
        (j as f64 - 0.5) / size,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::sampling::{hammersley, uniform_sphere};

    #[test]
    fn lookups_are_those_of_the_bilinear_cube() {
        let map = CubeMap::from_fn(16, |d| DVec3::new(d.x, d.y * d.z, 1.0 + d.z));
        let pyramid = CubePyramid::new(map.clone());
        assert_eq!((pyramid.levels(), pyramid.edge()), (5, 16));
        for k in 0..4000 {
            let d = uniform_sphere(hammersley(k, 4000));
            // The three texels of a corner are met differently.
            if d.abs().min_element() > 0.5 {
                continue;
            }
            let error = pyramid.trilinear(d, 0.0).as_dvec3() - map.bilinear(d);
            assert!(error.length() < 1e-6, "{d}: {error}");
            let halved = map.halved();
            let half = 0.5 * (map.bilinear(d) + halved.bilinear(d));
            let error = pyramid.trilinear(d, 0.5).as_dvec3() - half;
            assert!(error.length() < 1e-6, "{d}: {error}");
        }
    }

    #[test]
    fn a_corner_is_the_mean_of_its_three_texels() {
        let faces = CubeMap::from_fn(4, |d| {
            DVec3::from(
                d.abs()
                    .to_array()
                    .map(|c| if c == d.abs().max_element() { 1.0 } else { 0.0 }),
            )
        });
        let corner = CubePyramid::new(faces).trilinear(DVec3::ONE.normalize(), 0.0);
        // A quarter each of three texels, and of their mean.
        assert!((corner - Vec3::splat(1.0 / 3.0)).length() < 0.1, "{corner}");
        let sum = corner.x + corner.y + corner.z;
        assert!((sum - 1.0).abs() < 1e-6, "{sum}");
    }

    #[test]
    fn beyond_the_last_level_is_the_last() {
        let pyramid = CubePyramid::new(CubeMap::from_fn(2, |d| d));
        let d = DVec3::new(0.3, 0.9, -0.1).normalize();
        assert_eq!(pyramid.trilinear(d, 1.0), pyramid.trilinear(d, 7.5));
    }
}
