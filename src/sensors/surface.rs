//! The surfaces of a scene as paths see them: ray queries, diffuse reflectance, emission, cut-outs, panes of glass.

use std::borrow::Cow;
use std::cell::Cell;

use glam::{DVec2, DVec3, Vec2, Vec3};

use super::panes::{Pane, panes};
use crate::daylight::colour::luminance;
use crate::scene::{
    Blocker, Bundle, Bvh, Emitters, Encoding, Hit, LANES, Material, Ray, Reflectances, Scene,
    Texture,
};

/// A scene as paths see it.
pub struct TracedScene<'a> {
    scene: &'a Scene,
    bvh: Cow<'a, Bvh>,
    /// Number of the material of each triangle.
    material_of: Vec<u32>,
    /// Whether any surface has holes.
    has_cut_outs: bool,
    /// The pane of each material, if it is one; empty without any.
    panes: Vec<Option<Pane>>,
    /// The hierarchy of the panes alone.
    bvh_of_panes: Bvh,
    /// [`Scene::glass_slabs`].
    slabs: Vec<bool>,
    emitters: Emitters,
    /// Density of sampled points on each triangle, per m²; empty if nothing emits.
    emitter_densities: Vec<f64>,
}

/// Light that a surface emits toward a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Emitted {
    /// Radiance L_e, linear RGB, cd/m².
    pub radiance: DVec3,
    /// Unit vector from the receiver.
    pub toward: DVec3,
    /// Density of that direction by [`TracedScene::emitter`], per steradian.
    pub density: f64,
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
    /// Radiance L_e, linear RGB, cd/m².
    pub emission: DVec3,
    /// Density, by [`TracedScene::emitter`], of the direction of the ray that found it, per steradian.
    pub emitter_density: f64,
}

/// What a ray meets behind panes of glass.
#[derive(Debug, Clone, Copy)]
pub(super) struct Met {
    /// The surface, if there is one.
    pub point: Option<Point>,
    /// The direction in which it was met, or the sky was: another one after a pane mirrored the ray.
    pub direction: Vec3,
    /// Factor on its light, linear RGB: of the panes.
    pub through: DVec3,
    /// Whether a pane mirrored the ray.
    pub is_mirrored: bool,
}

/// Panes that a ray passes or is mirrored by at most; almost nothing is left then.
const MOST_PANES: u32 = 64;

/// Offset of ray origins from their surface, relative to the largest coordinate: covers the rounding of `f32`.
const OFFSET: f32 = 3e-5;

impl<'a> TracedScene<'a> {
    /// Builds the hierarchy, unless the scene has one.
    pub fn new(scene: &'a Scene) -> Self {
        let emitters = emitters(scene);
        Self {
            emitter_densities: densities(scene, &emitters),
            emitters,
            bvh: scene.hierarchy(),
            material_of: scene.triangle_materials(),
            has_cut_outs: scene.materials.iter().any(|m| m.alpha_cutoff.is_some()),
            panes: panes(&scene.materials),
            bvh_of_panes: Bvh::of(scene, |part| {
                scene.materials[part.material as usize].glass.is_some()
            }),
            slabs: scene.glass_slabs(),
            scene,
        }
    }

    /// What a ray from `origin` toward `direction`, a unit vector, meets first that is no pane of glass. Panes mirror it by chance, as
    /// `random` numbers say, and dim it.
    pub(super) fn first(
        &self,
        origin: Vec3,
        direction: Vec3,
        mut random: impl FnMut() -> f64,
    ) -> Met {
        let mut ray = Ray { origin, direction };
        let mut met = Met {
            point: None,
            direction,
            through: DVec3::ONE,
            is_mirrored: false,
        };
        for _ in 0..MOST_PANES {
            let is_solid = |hit: &Hit| self.is_solid(hit);
            let Some(hit) = self.bvh.closest(&ray, 0.0, f32::INFINITY, is_solid) else {
                return met;
            };
            let Some([passed, mirrored]) = self.pane(&hit, ray.direction) else {
                met.point = Some(self.point(&hit, &ray));
                return met;
            };
            let normal = self.normal(&hit);
            let cosine = normal.dot(ray.direction);
            let chance = mirrored.max_element().min(0.99);
            let is_mirrored = random() < chance;
            let position = ray.origin + hit.distance * ray.direction;
            let ahead = if is_mirrored { -cosine } else { cosine };
            ray.origin = lifted(position, normal * 1f32.copysign(ahead));
            if is_mirrored {
                ray.direction = (ray.direction - 2.0 * cosine * normal).normalize_or(direction);
                met.direction = ray.direction;
                met.is_mirrored = true;
                met.through *= mirrored / chance;
            } else {
                met.through *= passed / (1.0 - chance);
            }
        }
        met.through = DVec3::ZERO;
        met
    }

    /// The point that a ray hits.
    fn point(&self, hit: &Hit, ray: &Ray) -> Point {
        let Ray { origin, direction } = *ray;
        let hit = *hit;
        let normal = self.normal(&hit);
        let toward = if normal.dot(direction) > 0.0 {
            -normal
        } else {
            normal
        };
        let position = origin + hit.distance * direction;
        let cosine = -toward.dot(direction);
        Point {
            position: lifted(position, toward),
            normal: toward,
            reflectance: self.reflectance(&hit),
            emission: self.emission(&hit),
            emitter_density: self.density(hit.triangle, hit.distance, cosine),
        }
    }

    /// Whether panes colour the light that passes.
    pub(super) fn is_tinted(&self) -> bool {
        self.panes.iter().flatten().any(Pane::is_tinted)
    }

    /// Whether any surface emits light.
    pub(super) fn is_emissive(&self) -> bool {
        !self.emitters.list().is_empty()
    }

    /// The light toward `origin` of a point that emits, chosen by `xi`, if nothing hides it.
    pub(super) fn emitter(&self, origin: Vec3, xi: DVec2) -> Option<Emitted> {
        let (emitter, barycentrics) = self.emitters.sample(xi)?;
        let hit = Hit {
            distance: 0.0,
            triangle: emitter.triangle,
            barycentrics,
        };
        if !self.is_solid(&hit) {
            return None;
        }
        let [a, b, c] = self.positions(&hit);
        let target = a + barycentrics[0] * (b - a) + barycentrics[1] * (c - a);
        let normal = self.normal(&hit);
        let side = if normal.dot(origin - target) < 0.0 {
            -normal
        } else {
            normal
        };
        let way = lifted(target, side) - origin;
        let (toward, distance) = (way.try_normalize()?, way.length());
        let through = self.passing(origin, toward, distance);
        (through != DVec3::ZERO).then(|| Emitted {
            radiance: self.emission(&hit) * through,
            toward: toward.as_dvec3(),
            density: self.density(emitter.triangle, distance, -side.dot(toward)),
        })
    }

    /// Density of a direction toward a point of a triangle, per steradian: 0 if it does not emit.
    fn density(&self, triangle: u32, distance: f32, cosine: f32) -> f64 {
        let per_area = self.emitter_densities.get(triangle as usize);
        per_area.map_or(0.0, |density| {
            density * f64::from(distance).powi(2) / f64::from(cosine).max(1e-6)
        })
    }

    fn emission(&self, hit: &Hit) -> DVec3 {
        let material = self.material(hit);
        let map = material.emissive_texture.map(|t| &self.scene.textures[t]);
        let map = map.map_or([1.0; 4], |texture| sample(texture, self.uv(hit)));
        let [r, g, b] = std::array::from_fn(|i| f64::from(material.emission[i] * map[i]));
        DVec3::new(r, g, b)
    }

    /// The part of the light that passes from `origin` toward `direction`, a unit vector, before the distance `far`: what panes of glass
    /// let through, 0 where something opaque is in the way.
    pub(super) fn passing(&self, origin: Vec3, direction: Vec3, far: f32) -> DVec3 {
        let ray = Ray { origin, direction };
        let through = Cell::new(DVec3::ONE);
        let is_hidden = self.bvh.any(&ray, 0.0, far, |hit: &Hit| {
            let Some([passed, _]) = self.pane(hit, direction) else {
                return self.is_solid(hit);
            };
            through.set(through.get() * passed);
            false
        });
        if is_hidden {
            DVec3::ZERO
        } else {
            through.get()
        }
    }

    /// Whether anything is between two points, a pane too.
    pub(super) fn is_parted(&self, a: Vec3, b: Vec3) -> bool {
        let (direction, far) = (b - a).normalize_and_length();
        let ray = Ray {
            origin: a,
            direction,
        };
        self.bvh.any(&ray, 0.0, far, |hit| self.is_solid(hit))
    }

    /// Of the rays `lanes` of a bundle from `origin` those that reach the sky straight on, and what panes leave of their light, linear RGB.
    pub(super) fn passing_each(
        &self,
        origin: Vec3,
        (bundle, lanes): (&Bundle, u32),
        blocker: &mut Blocker,
    ) -> (u32, [Vec3; LANES]) {
        let mut through = [Vec3::ONE; LANES];
        let open = self
            .bvh
            .open(origin, (bundle, lanes), blocker, |triangle, met| {
                let is_pane = self.pane_of(triangle.number).is_some();
                if !is_pane && !self.has_cut_outs {
                    return met;
                }
                let mut stopped = 0;
                for lane in lanes_of(met) {
                    let direction = bundle.direction(lane);
                    let ray = Ray { origin, direction };
                    let Some(hit) = triangle.meet(&ray, 0.0, f32::INFINITY) else {
                        continue;
                    };
                    match self.pane(&hit, direction) {
                        Some([passed, _]) => through[lane] *= passed.as_vec3(),
                        None => stopped |= u32::from(self.is_solid(&hit)) << lane,
                    }
                }
                stopped
            });
        (open, through)
    }

    /// Of the rays `lanes` of a bundle from `origin` those that meet a pane of glass, whatever hides it.
    pub(super) fn meet_panes(&self, origin: Vec3, bundle: &Bundle, lanes: u32) -> u32 {
        let open = self.bvh_of_panes.open(
            origin,
            (bundle, lanes),
            &mut Blocker::default(),
            |_, met| met,
        );
        lanes & !open
    }

    /// The pane of a triangle, if it is one.
    fn pane_of(&self, triangle: u32) -> Option<&Pane> {
        if self.panes.is_empty() {
            return None;
        }
        self.panes[self.material_of[triangle as usize] as usize].as_ref()
    }

    /// What a pane that is hit lets through and mirrors, linear RGB; `None` for other surfaces.
    fn pane(&self, hit: &Hit, direction: Vec3) -> Option<[DVec3; 2]> {
        let pane = self.pane_of(hit.triangle)?;
        let cosine = self.normal(hit).dot(direction);
        if cosine > 0.0 && self.slabs[hit.triangle as usize] {
            return Some([DVec3::ONE, DVec3::ZERO]);
        }
        Some(pane.at(cosine).map(Vec3::as_dvec3))
    }

    fn material(&self, hit: &Hit) -> &Material {
        &self.scene.materials[self.material_of[hit.triangle as usize] as usize]
    }

    fn corners(&self, hit: &Hit) -> [usize; 3] {
        let first = 3 * hit.triangle as usize;
        [0, 1, 2].map(|i| self.scene.indices[first + i] as usize)
    }

    fn positions(&self, hit: &Hit) -> [Vec3; 3] {
        self.corners(hit)
            .map(|v| Vec3::from(self.scene.positions[v]))
    }

    /// Unit normal of the triangle's plane.
    fn normal(&self, hit: &Hit) -> Vec3 {
        let [a, b, c] = self.positions(hit);
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
        let diffuse = material.scattered();
        let [r, g, b] = std::array::from_fn(|i| f64::from(diffuse[i] * map[i] * vertex[i]));
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

/// The set of the rays whose cosine with a normal is above 0.
pub(super) fn before(cosines: &[f32; LANES]) -> u32 {
    let each = cosines.iter().enumerate();
    each.fold(0, |set, (lane, cosine)| {
        set | u32::from(*cosine > 0.0) << lane
    })
}

/// The numbers of the rays of a set.
pub(super) fn lanes_of(mut set: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = set.trailing_zeros() as usize;
        set &= set.wrapping_sub(1);
        (lane < LANES).then_some(lane)
    })
}

fn emitters(scene: &Scene) -> Emitters {
    if scene.is_emissive() {
        Emitters::of(scene, &Reflectances::new(scene), |rgb| {
            luminance(rgb.as_dvec3())
        })
    } else {
        Emitters::default()
    }
}

/// Density of sampled points on each triangle, per m²; empty if nothing emits.
fn densities(scene: &Scene, emitters: &Emitters) -> Vec<f64> {
    if emitters.list().is_empty() {
        return Vec::new();
    }
    let mut densities = vec![0.0; scene.triangles()];
    for emitter in emitters.list() {
        densities[emitter.triangle as usize] = emitters.density(emitter.luminance);
    }
    densities
}

/// A point offset along `normal` against self-intersection.
pub(super) fn lifted(position: Vec3, normal: Vec3) -> Vec3 {
    position + OFFSET * (1.0 + position.abs().max_element()) * normal
}

/// Bilinear lookup of the finest level in linear light.
fn sample(texture: &Texture, uv: Vec2) -> [f32; 4] {
    let size = Vec2::new(texture.width as f32, texture.height as f32);
    let at = uv * size - 0.5;
    let (low, share) = (at.floor(), at - at.floor());
    let texel = |dx: f32, dy: f32| {
        let [u, v] = texture.wrap;
        let x = u.texel((low.x + dx) as i64, texture.width);
        let y = v.texel((low.y + dy) as i64, texture.height);
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
        "maps of ρ_d and L_e hold colours"
    );
    std::array::from_fn(|i| {
        let top = a[i] + share.x * (b[i] - a[i]);
        let bottom = c[i] + share.x * (d[i] - c[i]);
        top + share.y * (bottom - top)
    })
}
