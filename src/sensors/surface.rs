//! The surfaces of a scene as paths see them: ray queries, diffuse reflectance, cut-outs.

use std::borrow::Cow;

use glam::{DVec3, Vec2, Vec3};

use crate::scene::{Bvh, Encoding, Hit, Material, Ray, Scene, Texture};

/// A scene as paths see it.
pub struct TracedScene<'a> {
    scene: &'a Scene,
    bvh: Cow<'a, Bvh>,
    /// Number of the material of each triangle.
    material_of: Vec<u32>,
    /// Whether any surface has holes.
    has_cut_outs: bool,
}

/// A point of a surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    /// World space, metres.
    pub position: Vec3,
    /// Unit vector of the triangle's plane toward the side that was hit.
    pub normal: Vec3,
    /// Diffuse reflectance ρ_d, linear RGB, 0..1.
    pub reflectance: DVec3,
}

/// Offset of ray origins from their surface, relative to the largest coordinate: covers the rounding of `f32`.
const OFFSET: f32 = 3e-5;

impl<'a> TracedScene<'a> {
    /// Builds the hierarchy, unless the scene has one.
    pub fn new(scene: &'a Scene) -> Self {
        Self {
            bvh: scene.hierarchy(),
            material_of: scene.triangle_materials(),
            has_cut_outs: scene.materials.iter().any(|m| m.alpha_cutoff.is_some()),
            scene,
        }
    }

    /// What a ray from `origin` toward `direction`, a unit vector, meets first.
    pub(super) fn first(&self, origin: Vec3, direction: Vec3) -> Option<Point> {
        let ray = Ray { origin, direction };
        let is_solid = |hit: &Hit| self.is_solid(hit);
        let hit = self.bvh.closest(&ray, 0.0, f32::INFINITY, is_solid)?;
        let normal = self.normal(&hit);
        let toward = if normal.dot(direction) > 0.0 {
            -normal
        } else {
            normal
        };
        let position = origin + hit.distance * direction;
        Some(Point {
            position: lifted(position, toward),
            normal: toward,
            reflectance: self.reflectance(&hit),
        })
    }

    /// Whether nothing lies on the way from `origin` toward `direction`, a unit vector.
    pub(super) fn is_open(&self, origin: Vec3, direction: Vec3) -> bool {
        let ray = Ray { origin, direction };
        let is_solid = |hit: &Hit| self.is_solid(hit);
        !self.bvh.any(&ray, 0.0, f32::INFINITY, is_solid)
    }

    fn material(&self, hit: &Hit) -> &Material {
        &self.scene.materials[self.material_of[hit.triangle as usize] as usize]
    }

    fn corners(&self, hit: &Hit) -> [usize; 3] {
        let first = 3 * hit.triangle as usize;
        [0, 1, 2].map(|i| self.scene.indices[first + i] as usize)
    }

    /// Unit normal of the triangle's plane.
    fn normal(&self, hit: &Hit) -> Vec3 {
        let [a, b, c] = self
            .corners(hit)
            .map(|v| Vec3::from(self.scene.positions[v]));
        (b - a).cross(c - a).normalize_or(Vec3::Y)
    }

    fn uv(&self, hit: &Hit) -> Vec2 {
        let [a, b, c] = self
            .corners(hit)
            .map(|v| Vec2::from(self.scene.texcoords[v]));
        let [u, v] = hit.barycentrics;
        a + u * (b - a) + v * (c - a)
    }

    /// Colour of the vertices, linear RGBA; white without one.
    fn vertex_colour(&self, hit: &Hit) -> [f32; 4] {
        if self.scene.colours.is_empty() {
            return [1.0; 4];
        }
        let [a, b, c] = self.corners(hit).map(|v| self.scene.colours[v]);
        let [u, v] = hit.barycentrics;
        let share = |x: u16| f32::from(x) / f32::from(u16::MAX);
        std::array::from_fn(|i| (1.0 - u - v) * share(a[i]) + u * share(b[i]) + v * share(c[i]))
    }

    /// RGBA of the map of ρ_d; white without one.
    fn map(&self, material: &Material, hit: &Hit) -> [f32; 4] {
        let texture = material.diffuse_texture.map(|t| &self.scene.textures[t]);
        texture.map_or([1.0; 4], |texture| sample(texture, self.uv(hit)))
    }

    fn reflectance(&self, hit: &Hit) -> DVec3 {
        let material = self.material(hit);
        let (map, vertex) = (self.map(material, hit), self.vertex_colour(hit));
        let [r, g, b] =
            std::array::from_fn(|i| f64::from(material.diffuse[i] * map[i] * vertex[i]));
        DVec3::new(r, g, b)
    }

    /// Whether a hit is on a surface and not on a hole of a cut-out.
    fn is_solid(&self, hit: &Hit) -> bool {
        if !self.has_cut_outs {
            return true;
        }
        let material = self.material(hit);
        material.alpha_cutoff.is_none_or(|cutoff| {
            let alpha = self.map(material, hit)[3] * self.vertex_colour(hit)[3];
            material.dissolve * alpha >= cutoff
        })
    }
}

/// A point offset along `normal` against self-intersection.
pub(super) fn lifted(position: Vec3, normal: Vec3) -> Vec3 {
    position + OFFSET * (1.0 + position.abs().max_element()) * normal
}

/// Bilinear lookup of the finest level, repeating, in linear light.
fn sample(texture: &Texture, uv: Vec2) -> [f32; 4] {
    let size = Vec2::new(texture.width as f32, texture.height as f32);
    let at = (uv - uv.floor()) * size - 0.5;
    let (low, share) = (at.floor(), at - at.floor());
    let texel = |dx: f32, dy: f32| {
        let wrap = |v: f32, n: u32| (v as i64).rem_euclid(i64::from(n)) as u32;
        let (x, y) = (
            wrap(low.x + dx, texture.width),
            wrap(low.y + dy, texture.height),
        );
        texture.linear(x, y)
    };
    let (a, b, c, d) = (
        texel(0.0, 0.0),
        texel(1.0, 0.0),
        texel(0.0, 1.0),
        texel(1.0, 1.0),
    );
    debug_assert!(
        texture.encoding == Encoding::Srgb,
        "maps of ρ_d hold colours"
    );
    std::array::from_fn(|i| {
        let top = a[i] + share.x * (b[i] - a[i]);
        let bottom = c[i] + share.x * (d[i] - c[i]);
        top + share.y * (bottom - top)
    })
}
