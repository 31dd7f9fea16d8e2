//! Small scenes and skies whose light is known; no device.

use crate::daylight::glass::{internal_transmittance, pane};
use crate::daylight::sky::{Conditions, Daylight, SkyModel};
use crate::scene::{Bounds, Material, Part, Scene};
use glam::{DVec3, Quat, Vec3};

/// Preetham's clear sky with the sun at an azimuth and an elevation, degrees.
pub fn clear_day(azimuth: f64, elevation: f64) -> Daylight {
    Daylight::new(&Conditions {
        model: SkyModel::Preetham,
        sun_azimuth_deg: azimuth,
        sun_elevation_deg: elevation,
        ..Conditions::default()
    })
}

/// Uniform environment: sky and ground of one luminance, cd/m², and no sun.
pub fn constant_sky(luminance: f64) -> Daylight {
    let mut day = clear_day(180.0, 45.0);
    day.guard.scale = 0.0;
    day.guard.night = DVec3::splat(luminance);
    day.ground_luminance = DVec3::splat(luminance);
    day.sky_irradiance_up = DVec3::splat(luminance * std::f64::consts::PI);
    day.sun_illuminance = DVec3::ZERO;
    day.sun_luminance = DVec3::ZERO;
    day
}

/// A Lambertian material.
pub fn matt(diffuse: f32) -> Material {
    Material {
        diffuse: [diffuse; 3],
        ..Material::default()
    }
}

/// A Lambertian material that emits grey light, cd/m².
pub fn glowing(diffuse: f32, emission: f32) -> Material {
    Material {
        emission: [emission; 3],
        ..matt(diffuse)
    }
}

/// A pane of clear glass with this transmittance at normal incidence.
pub fn glass(transmittance: [f32; 3]) -> Material {
    Material {
        glass: Some(transmittance),
        ..matt(0.0)
    }
}

/// The part of a uniform sky's light that a pane of this transmittance at normal incidence lets through: 2 times the integral of
/// T sin cos, by quadrature.
pub fn hemispherical_transmittance(normal: f64) -> f64 {
    let (n, internal) = (4000, internal_transmittance(normal));
    let angle = |i: usize| (i as f64 + 0.5) / n as f64 * std::f64::consts::FRAC_PI_2;
    let share = |a: f64| 2.0 * pane(internal, a.cos())[0] * a.sin() * a.cos();
    (0..n).map(|i| share(angle(i))).sum::<f64>() * std::f64::consts::FRAC_PI_2 / n as f64
}

/// A closed box around the origin; every surface has this material.
pub fn closed_box(half: f32, material: &Material) -> Scene {
    Model::default().cube([0.0; 3], half, material).build()
}

/// Irradiance of a uniform polygon of radiance 1 on a point in front of it, lux: Lambert 1760, half the sum over its edges of the angle
/// that an edge subtends times the cosine between the normal and that of the edge's plane. `corners` are above the point's horizon.
pub fn polygon_irradiance(corners: &[DVec3], point: DVec3, normal: DVec3) -> f64 {
    let toward = |i: usize| (corners[i % corners.len()] - point).normalize();
    let edge = |i: usize| {
        let (a, b) = (toward(i), toward(i + 1));
        let angle = a.dot(b).clamp(-1.0, 1.0).acos();
        angle * a.cross(b).normalize().dot(normal)
    };
    0.5 * (0..corners.len()).map(edge).sum::<f64>().abs()
}

/// Builder of a scene: each part has its own material.
#[derive(Default)]
pub struct Model(Scene);

impl Model {
    fn part(&mut self, material: &Material, mesh: impl FnOnce(&mut Scene)) {
        let (vertex, index) = (self.0.positions.len(), self.0.indices.len());
        mesh(&mut self.0);
        let points = self.0.positions[vertex..].iter().map(|p| Vec3::from(*p));
        let bounds = Bounds::of(points);
        self.0.parts.push(Part {
            has_colours: false,
            first_index: index as u32,
            index_count: (self.0.indices.len() - index) as u32,
            material: self.0.materials.len() as u32,
            bounds,
        });
        self.0.materials.push(material.clone());
        self.0.bounds = self.0.bounds.union(bounds);
    }

    /// A parallelogram: a corner and its two edges, counter-clockwise seen from the front.
    pub fn quad(mut self, corner: [f32; 3], a: [f32; 3], b: [f32; 3], material: &Material) -> Self {
        let (corner, a, b) = (Vec3::from(corner), Vec3::from(a), Vec3::from(b));
        self.part(material, |scene| quad(scene, corner, a, b));
        self
    }

    /// A horizontal square at y = 0 around the origin, facing up.
    pub fn ground(self, half: f32, material: &Material) -> Self {
        self.square([0.0; 3], half, material)
    }

    /// A horizontal square facing up; the position is its centre.
    pub fn square(self, [x, y, z]: [f32; 3], half: f32, material: &Material) -> Self {
        let edge = 2.0 * half;
        self.quad(
            [x - half, y, z + half],
            [edge, 0.0, 0.0],
            [0.0, 0.0, -edge],
            material,
        )
    }

    /// A cube; `half` is half its edge.
    pub fn cube(mut self, centre: [f32; 3], half: f32, material: &Material) -> Self {
        let centre = Vec3::from(centre);
        self.part(material, |scene| {
            for n in [Vec3::X, Vec3::Y, Vec3::Z]
                .into_iter()
                .flat_map(|n| [n, -n])
            {
                let a = n.any_orthonormal_vector() * half;
                let b = n.cross(a);
                quad(scene, centre + n * half - a - b, 2.0 * a, 2.0 * b);
            }
        });
        self
    }

    /// A sphere of `2 rings x rings` quads with smooth normals.
    pub fn sphere(
        mut self,
        centre: [f32; 3],
        radius: f32,
        rings: u32,
        material: &Material,
    ) -> Self {
        self.part(material, |scene| {
            sphere(scene, centre.into(), radius, rings);
        });
        self
    }

    /// Triangles, each by its corners, counter-clockwise seen from the front.
    pub fn triangles(mut self, list: &[[Vec3; 3]], material: &Material) -> Self {
        self.part(material, |scene| {
            for corners in list {
                triangle(scene, *corners);
            }
        });
        self
    }

    /// A box with sides along the axes, turned about +Y by `turn`, radians.
    pub fn slab(mut self, low: [f32; 3], high: [f32; 3], turn: f32, material: &Material) -> Self {
        let bounds = Bounds {
            min: low.into(),
            max: high.into(),
        };
        let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| axis * bounds.extent());
        let turn = Quat::from_rotation_y(turn);
        let (low, high) = (bounds.min, bounds.max);
        self.part(material, |scene| {
            for (a, b) in [(x, y), (y, z), (z, x)] {
                quad(scene, turn * high, turn * -a, turn * -b);
                quad(scene, turn * low, turn * b, turn * a);
            }
        });
        self
    }

    /// The scene.
    pub fn build(self) -> Scene {
        self.0
    }
}

fn triangle(scene: &mut Scene, [a, b, c]: [Vec3; 3]) {
    let first = scene.positions.len() as u32;
    let normal = (b - a).cross(c - a).normalize();
    for corner in [a, b, c] {
        scene.positions.push(corner.into());
        scene.normals.push(normal.into());
        scene.texcoords.push([0.0; 2]);
    }
    scene.indices.extend([first, first + 1, first + 2]);
}

fn quad(scene: &mut Scene, corner: Vec3, a: Vec3, b: Vec3) {
    let first = scene.positions.len() as u32;
    let normal = a.cross(b).normalize();
    for (s, t) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
        scene.positions.push((corner + a * s + b * t).into());
        scene.normals.push(normal.into());
        scene.texcoords.push([s, t]);
    }
    scene
        .indices
        .extend([0, 1, 2, 0, 2, 3].map(|i: u32| first + i));
}

fn sphere(scene: &mut Scene, centre: Vec3, radius: f32, rings: u32) {
    let first = scene.positions.len() as u32;
    let columns = 2 * rings + 1;
    for ring in 0..=rings {
        for column in 0..columns {
            let (s, t) = (
                column as f32 / (columns - 1) as f32,
                ring as f32 / rings as f32,
            );
            let (sin_phi, cos_phi) = (s * std::f32::consts::TAU).sin_cos();
            let (sin_theta, cos_theta) = (t * std::f32::consts::PI).sin_cos();
            let n = Vec3::new(sin_theta * cos_phi, cos_theta, -sin_theta * sin_phi);
            scene.positions.push((centre + n * radius).into());
            scene.normals.push(n.into());
            scene.texcoords.push([s, t]);
        }
    }
    for ring in 0..rings {
        for column in 0..columns - 1 {
            let i = first + ring * columns + column;
            let below = i + columns;
            scene
                .indices
                .extend([i, below, below + 1, i, below + 1, i + 1]);
        }
    }
}
