//! The triangles that emit light, and points on them for direct sampling.
//!
//! A triangle is chosen by its power, a point on it uniformly: the density per area of a point is the luminance of its triangle over
//! the sum of area times luminance (Shirley, Wang and Zimmerman 1996, "Monte Carlo techniques for direct lighting calculations").

use glam::{DVec2, Vec3};

use crate::scene::{Reflectances, Scene};

/// A triangle that emits light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Emitter {
    /// Its number in the scene.
    pub triangle: u32,
    /// Mean luminance, cd/m².
    pub luminance: f64,
    /// Power of this and all earlier ones, as a fraction of all.
    pub up_to: f64,
}

/// All emitters of a scene.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Emitters {
    list: Vec<Emitter>,
    total: f64,
}

impl Emitters {
    /// Finds the emitters of a scene. `luminance`: of a colour.
    pub fn of(scene: &Scene, means: &Reflectances<'_>, luminance: impl Fn(Vec3) -> f64) -> Self {
        let mut all = Self::default();
        for part in &scene.parts {
            if !scene.materials[part.material as usize].is_emissive() {
                continue;
            }
            let first = part.first_index / 3;
            for triangle in first..first + part.index_count / 3 {
                let emission = Vec3::from(means.of(triangle).emission);
                all.add(triangle, luminance(emission), area(scene, triangle));
            }
        }
        for emitter in &mut all.list {
            emitter.up_to /= all.total;
        }
        all
    }

    fn add(&mut self, triangle: u32, luminance: f64, area: f64) {
        if luminance * area > 0.0 {
            self.total += luminance * area;
            self.list.push(Emitter {
                triangle,
                luminance,
                up_to: self.total,
            });
        }
    }

    /// The emitters, in the order of their `up_to`.
    pub fn list(&self) -> &[Emitter] {
        &self.list
    }

    /// Sum of area times luminance, cd.
    pub fn total(&self) -> f64 {
        self.total
    }

    /// The emitter for a point in [0, 1)², chosen by power, and barycentric weights of the second and third corner of a point on it.
    /// `None` if nothing emits.
    pub fn sample(&self, xi: DVec2) -> Option<(&Emitter, [f32; 2])> {
        let at = self.list.partition_point(|emitter| emitter.up_to <= xi.x);
        let emitter = self.list.get(at).or(self.list.last())?;
        let from = at.checked_sub(1).map_or(0.0, |i| self.list[i].up_to);
        let within = ((xi.x - from) / (emitter.up_to - from)).clamp(0.0, 1.0);
        let root = within.sqrt();
        Some((
            emitter,
            [(root * (1.0 - xi.y)) as f32, (root * xi.y) as f32],
        ))
    }

    /// Density of the points of [`Emitters::sample`] on a triangle of this mean luminance, per m².
    pub fn density(&self, luminance: f64) -> f64 {
        if self.total > 0.0 {
            luminance / self.total
        } else {
            0.0
        }
    }
}

/// Area of a triangle, m².
fn area(scene: &Scene, triangle: u32) -> f64 {
    let first = 3 * triangle as usize;
    let [a, b, c] = [0, 1, 2]
        .map(|i| Vec3::from(scene.positions[scene.indices[first + i] as usize]).as_dvec3());
    0.5 * (b - a).cross(c - a).length()
}
