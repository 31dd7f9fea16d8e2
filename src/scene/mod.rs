//! Models, materials, textures, cameras and scene files; independent of the device.
//!
//! [`load`] reads a scene file or a model into a [`Scene`]: all meshes in world space, in one arena of vertices and indices,
//! ready for upload. World space is right-handed, in metres, with +Y up, +X east and −Z north; it is read in `f64`. Positions are
//! kept in `f32` relative to [`Scene::origin`], which is not zero for models with the coordinates of a map.

mod adjusted;
mod bounds;
mod builder;
mod bundled;
mod bvh;
mod cache;
mod camera;
mod culling;
mod digest;
mod emitters;
mod error;
mod files;
mod glass;
mod gltf;
mod hills;
mod load;
mod losses;
mod material;
mod mesh;
mod microfacet;
mod names;
mod number;
mod obj;
mod origin;
mod placement;
mod progress;
mod reflectance;
mod scene_file;
mod section;
mod size;
mod subject;
mod texture;

use std::borrow::Cow;

use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};

pub use bounds::Bounds;
pub use bundled::{BUNDLED, bundled, bundled_name};
pub use bvh::{Blocker, Bundle, Bvh, Hit, LANES, LEAF_TRIANGLES, Node, Ray, Triangle};
pub use camera::{Camera, DEFAULT_FOV_DEG};
pub use culling::bodies::{Bodies, Body};
pub use culling::clusters::{Cluster, Clusters, Solid};
pub use culling::layout::Layout;
pub use emitters::{Emitter, Emitters};
pub use error::SceneError;
pub(crate) use error::shown;
pub use hills::hills;
pub use load::{LoadOptions, Loaded, load, load_with_progress};
pub(crate) use losses::shortened;
pub use material::{MAX_EMISSION, Material};
pub use microfacet::Microfacet;
pub use placement::{Unit, Up};
pub use progress::Progress;
pub use reflectance::{Mean, Reflectances};
pub(crate) use scene_file::option_text;
pub use scene_file::{NamedCamera, NamedMoment, NamedOptions, weather_of};
pub use subject::Subject;
pub use texture::{Encoding, Texture, Wrap};

use load::append_model;
use material::bounded_emission;

/// Emission up to which a model may mean a share of white instead of a luminance, cd/m².
const UNITLESS: f32 = 1.0;

/// A scene: one arena of vertices, parts that draw ranges of it, materials and textures.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The point of world space that the positions are relative to, metres: zero, unless the model lies far from the world's origin.
    pub origin: DVec3,
    /// Vertex positions relative to `origin`, with the axes of world space, metres.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals in world space, one per position.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates, one per position; (0, 0) is the corner of the first texel of the first row.
    pub texcoords: Vec<[f32; 2]>,
    /// Linear RGBA factors on ρ_d and opacity, 0..65535 for 0..1. One per position, or empty.
    pub colours: Vec<[u16; 4]>,
    /// For normal maps: unit tangent toward increasing u, then the sign of the bitangent (normal x tangent x sign points toward
    /// the upper rows of the texture), −32767..32767 for −1..1. One per position, or empty.
    pub tangents: Vec<[i16; 4]>,
    /// Three per triangle, counter-clockwise seen from the front, indexing `positions`.
    pub indices: Vec<u32>,
    /// Runs of triangles with one material. Together they cover `indices` without gaps.
    pub parts: Vec<Part>,
    /// Materials, indexed by [`Part::material`].
    pub materials: Vec<Material>,
    /// Textures, indexed by the texture fields of [`Material`].
    pub textures: Vec<Texture>,
    /// Bounds of all parts, relative to `origin`, metres.
    pub bounds: Bounds,
    /// Import warnings, one line each.
    pub warnings: Vec<String>,
    /// Draw layout, if computed. It is valid for the current order of `indices`.
    pub layout: Option<Layout>,
    /// Hierarchy over all triangles, if computed: see [`Scene::hierarchy`]. It is valid for the current `positions` and `indices`.
    pub bvh: Option<Bvh>,
}

/// A run of triangles of one mesh with one material.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// Offset in [`Scene::indices`].
    pub first_index: u32,
    /// Number of indices: a multiple of three, not zero.
    pub index_count: u32,
    /// Index in [`Scene::materials`].
    pub material: u32,
    /// Whether its vertices have colours.
    pub has_colours: bool,
    /// Bounds of its triangles, metres.
    pub bounds: Bounds,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            origin: DVec3::ZERO,
            positions: Vec::new(),
            normals: Vec::new(),
            texcoords: Vec::new(),
            colours: Vec::new(),
            tangents: Vec::new(),
            indices: Vec::new(),
            parts: Vec::new(),
            materials: Vec::new(),
            textures: Vec::new(),
            bounds: Bounds::EMPTY,
            warnings: Vec::new(),
            layout: None,
            bvh: None,
        }
    }
}

impl Scene {
    /// Pads colours and tangents to one per vertex, unless they are empty.
    fn pad_attributes(&mut self) {
        let vertices = self.positions.len();
        if !self.colours.is_empty() {
            self.colours.resize(vertices, [u16::MAX; 4]);
        }
        if !self.tangents.is_empty() {
            self.tangents.resize(vertices, [0; 4]);
        }
    }

    /// The same scene with all triangles in one part of its first material, without vertex colours.
    fn into_one_part(mut self) -> Self {
        self.bounds = Bounds::of(self.positions.iter().copied().map(Vec3::from));
        self.parts = vec![Part {
            first_index: 0,
            index_count: self.indices.len() as u32,
            material: 0,
            has_colours: false,
            bounds: self.bounds,
        }];
        self
    }

    /// Computes the draw layout and reorders the indices accordingly.
    pub fn arrange(&mut self) {
        let (indices, layout) = Layout::of(self);
        self.indices = indices;
        self.layout = Some(layout);
        self.bvh = None;
    }

    /// The hierarchy over all triangles: that of a model from the cache, or a new one.
    pub fn hierarchy(&self) -> Cow<'_, Bvh> {
        match &self.bvh {
            Some(bvh) => Cow::Borrowed(bvh),
            None => Cow::Owned(Bvh::of(self, |_| true)),
        }
    }

    /// For each part, whether it casts shadows. All parts do, except a flat ground (or sea) that lies below the centre of
    /// everything else and is more than four times as wide: it would stretch the shadow map over kilometres without receivers.
    pub fn casting(&self) -> Vec<bool> {
        let flat = |part: &Part| {
            let extent = part.bounds.extent();
            extent.y <= 1e-5 * extent.x.max(extent.z)
        };
        let solid = self.parts.iter().filter(|part| !flat(part));
        let solid = solid.fold(Bounds::EMPTY, |all, part| all.union(part.bounds));
        let extent = solid.extent();
        let is_ground = |part: &Part| {
            let wide = part.bounds.extent();
            flat(part)
                && wide.x.min(wide.z) > 4.0 * extent.x.max(extent.z)
                && part.bounds.max.y <= solid.centre().y
        };
        let casts = |part| solid.is_empty() || !is_ground(part);
        self.parts.iter().map(casts).collect()
    }

    /// Bounds of all shadow casters, metres.
    pub fn casters(&self) -> Bounds {
        let parts = self.parts.iter().zip(self.casting());
        let casting = parts.filter(|(_, casts)| *casts);
        casting.fold(Bounds::EMPTY, |all, (part, _)| all.union(part.bounds))
    }

    /// For each triangle, whether it is glass; empty without any.
    pub(in crate::scene) fn glass_triangles(&self) -> Vec<bool> {
        if self.materials.iter().all(|m| m.glass.is_none()) {
            return Vec::new();
        }
        let is_glass = |number: u32| self.materials[number as usize].glass.is_some();
        self.triangle_materials()
            .into_iter()
            .map(is_glass)
            .collect()
    }

    /// For each triangle, whether it belongs to a slab of glass, whose two faces are one pane: light that leaves it has been dimmed where
    /// it entered. Empty without glass.
    pub fn glass_slabs(&self) -> Vec<bool> {
        let glass = self.glass_triangles();
        if glass.is_empty() {
            return glass;
        }
        let bodies = Bodies::of(self);
        let corners = self.indices.chunks_exact(3).zip(glass);
        let is_slab =
            |vertex: u32| bodies.list[bodies.of_vertex[vertex as usize] as usize].is_slab();
        corners
            .map(|(c, is_glass)| is_glass && is_slab(c[0]))
            .collect()
    }

    /// Number of the material of each triangle.
    pub fn triangle_materials(&self) -> Vec<u32> {
        let mut material_of = vec![0; self.triangles()];
        for part in &self.parts {
            let first = part.first_index as usize / 3;
            let count = part.index_count as usize / 3;
            material_of[first..first + count].fill(part.material);
        }
        material_of
    }

    /// Whether any surface emits light.
    pub fn is_emissive(&self) -> bool {
        self.materials.iter().any(Material::is_emissive)
    }

    /// Gives all materials the lecture's model: Phong's lobe instead of GGX.
    pub fn use_phong(&mut self) {
        for material in &mut self.materials {
            material.microfacet = None;
        }
    }

    /// Multiplies the light that surfaces emit. What becomes brighter than [`MAX_EMISSION`] is cut, with a warning. Without a factor,
    /// light that nobody would see by day is told of: its numbers may have no unit.
    pub fn scale_emission(&mut self, factor: f32) {
        let mut is_cut = false;
        for material in &mut self.materials {
            let scaled = material.emission.map(|v| v * factor);
            material.emission = bounded_emission(scaled);
            is_cut |= material.emission != scaled;
        }
        let emitted = self.materials.iter().flat_map(|m| m.emission);
        let most = emitted.fold(0.0, f32::max);
        if factor == 1.0 && most > 0.0 && most <= UNITLESS {
            let what = format!(
                "surfaces emit at most {most} cd/m², too little to see by day; if that is no luminance, give --emission-scale, for instance 500"
            );
            self.warnings.push(what);
        }
        if is_cut {
            let what = format!(
                "emission above {MAX_EMISSION:e} cd/m² is cut; give a smaller --emission-scale"
            );
            self.warnings.push(what);
        }
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.indices.len() / 3
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(min: [f32; 3], max: [f32; 3]) -> Part {
        Part {
            first_index: 0,
            index_count: 3,
            material: 0,
            has_colours: false,
            bounds: Bounds {
                min: min.into(),
                max: max.into(),
            },
        }
    }

    #[test]
    fn a_wide_ground_casts_no_shadow_but_a_roof_does() {
        let house = part([-5.0, 0.0, -5.0], [5.0, 6.0, 5.0]);
        let sea = part([-900.0, 0.1, -900.0], [900.0, 0.1, 900.0]);
        let lawn = part([-9.0, 0.0, -9.0], [9.0, 0.0, 9.0]);
        let sail = part([-900.0, 9.0, -900.0], [900.0, 9.0, 900.0]);
        let scene = |parts: &[Part]| Scene {
            parts: parts.to_vec(),
            ..Scene::default()
        };
        assert_eq!(scene(&[house, sea, lawn]).casting(), [true, false, true]);
        assert_eq!(scene(&[house, sail]).casting(), [true, true]);
        assert_eq!(scene(&[sea]).casting(), [true], "the only part");
        assert_eq!(scene(&[house, sea]).casters().max, Vec3::new(5.0, 6.0, 5.0));
    }

    #[test]
    fn emission_is_scaled_and_what_is_odd_is_told() {
        let scaled = |emission: [f32; 3], factor: f32| {
            let mut scene = Scene {
                materials: vec![Material {
                    emission,
                    ..Material::default()
                }],
                ..Scene::default()
            };
            scene.scale_emission(factor);
            (scene.materials[0].emission, scene.warnings)
        };
        assert_eq!(scaled([0.0; 3], 1.0), ([0.0; 3], vec![]));
        assert_eq!(scaled([2.0, 1.0, 0.0], 500.0).0, [1000.0, 500.0, 0.0]);
        assert_eq!(scaled([2.0, 1.0, 0.0], 1.0).1, [""; 0]);
        assert_eq!(scaled([2.0, 1.0, 0.0], 0.0), ([0.0; 3], vec![]));
        let (bright, told) = scaled([1e4, 1.0, 0.0], 1e6);
        assert_eq!(bright, [MAX_EMISSION, 1e6, 0.0]);
        assert!(told[0].contains("is cut") && told.len() == 1, "{told:?}");
        let told = scaled([0.0, 1.0, 0.2], 1.0).1;
        assert!(
            told[0].contains("--emission-scale") && told.len() == 1,
            "{told:?}"
        );
    }
}
