//! Mean reflectance, emission and opacity of triangles, for rays that do not look up textures.

use glam::{Vec2, Vec3};

use crate::scene::{Material, Scene, Texture};

/// Divisions of the sides of a textured triangle: the square of this is the number of lookups.
const DIVISIONS: u32 = 8;
/// The same of a triangle over which the texture of a cut-out repeats.
const DIVISIONS_OF_REPEATS: u32 = 24;

/// Means over a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mean {
    /// Diffuse reflectance ρ_d of what is there, linear RGB, 0..1.
    pub diffuse: [f32; 3],
    /// Emitted radiance L_e of what is there, linear RGB, cd/m².
    pub emission: [f32; 3],
    /// Fraction of the area that is there: below 1 for cut-outs.
    pub opacity: f32,
    /// Transmittance of a pane of glass at normal incidence, linear RGB, 0..1, and whether the pane is a slab, of whose two faces only the
    /// one where light enters counts.
    pub glass: Option<([f32; 3], bool)>,
    /// Mean of the normals at the corners of a cut-out, unit: leaves have those of their crown.
    pub normal: Option<Vec3>,
}

/// Means of the triangles of a scene.
pub struct Reflectances<'a> {
    scene: &'a Scene,
    /// Material of each triangle.
    material_of: Vec<u32>,
    /// Mip levels of each texture that maps ρ_d or L_e, the finest first.
    levels: Vec<Vec<Texture>>,
    /// [`Scene::glass_slabs`].
    slabs: Vec<bool>,
}

impl<'a> Reflectances<'a> {
    /// Prepares the textures.
    pub fn new(scene: &'a Scene) -> Self {
        let is_used = |number: usize| {
            let mut materials = scene.materials.iter();
            materials.any(|m| [m.diffuse_texture, m.emissive_texture].contains(&Some(number)))
        };
        let levels = scene.textures.iter().enumerate().map(|(number, texture)| {
            if !is_used(number) {
                return Vec::new();
            }
            let mut levels = texture.mip_levels();
            levels.insert(0, texture.clone());
            levels
        });
        Self {
            levels: levels.collect(),
            material_of: scene.triangle_materials(),
            slabs: scene.glass_slabs(),
            scene,
        }
    }

    /// Means of a triangle.
    pub fn of(&self, triangle: u32) -> Mean {
        let material = &self.scene.materials[self.material_of[triangle as usize] as usize];
        let corners = [0, 1, 2].map(|i| self.scene.indices[3 * triangle as usize + i] as usize);
        if material.glass.is_some() {
            return Mean {
                diffuse: [0.0; 3],
                emission: [0.0; 3],
                opacity: 1.0,
                glass: material.glass.map(|t| (t, self.slabs[triangle as usize])),
                normal: None,
            };
        }
        let maps = [material.diffuse_texture, material.emissive_texture];
        if maps == [None; 2] && self.scene.colours.is_empty() {
            return Mean {
                diffuse: material.scattered(),
                emission: material.emission,
                opacity: 1.0,
                glass: None,
                normal: None,
            };
        }
        let maps = maps.map(|map| map.map(|number| self.level(number, material, corners)));
        let diffuse = material.scattered();
        let (mut sum, mut emitted) = ([0.0; 3], [0.0; 3]);
        let (mut solid, mut count) = (0.0, 0.0);
        let is_cut_out = material.alpha_cutoff.is_some();
        for weights in barycentric_points(self.divisions(material, corners), is_cut_out) {
            let uv = self.uv(corners, weights);
            let [map, glow] = maps.map(|map| map.map_or([1.0; 4], |t| nearest(t, uv)));
            let colour = self.colour(corners, weights);
            let alpha = material.dissolve * map[3] * colour[3];
            count += 1.0;
            if material.alpha_cutoff.is_some_and(|cutoff| alpha < cutoff) {
                continue;
            }
            solid += 1.0;
            for i in 0..3 {
                sum[i] += diffuse[i] * map[i] * colour[i];
                emitted[i] += material.emission[i] * glow[i];
            }
        }
        let mean = |sum: f32| if solid > 0.0 { sum / solid } else { 0.0 };
        Mean {
            diffuse: sum.map(mean),
            emission: emitted.map(mean),
            opacity: solid / count,
            glass: None,
            normal: is_cut_out.then(|| self.normal(corners)),
        }
    }

    /// Divisions of the sides of a triangle for its lookups.
    fn divisions(&self, material: &Material, corners: [usize; 3]) -> u32 {
        let is_mapped = material.alpha_cutoff.is_some() && material.diffuse_texture.is_some();
        let repeats = is_mapped && {
            let [a, b, c] = corners.map(|v| Vec2::from(self.scene.texcoords[v]));
            (a.max(b).max(c) - a.min(b).min(c)).max_element() > 1.0
        };
        if repeats {
            DIVISIONS_OF_REPEATS
        } else {
            DIVISIONS
        }
    }

    /// The mip level whose texels are about as many as the lookups of a triangle. Cut-outs need the finest: their edges are sharp.
    fn level(&self, number: usize, material: &Material, corners: [usize; 3]) -> &Texture {
        let levels = &self.levels[number];
        if material.alpha_cutoff.is_some() {
            return &levels[0];
        }
        let [a, b, c] = corners.map(|v| Vec2::from(self.scene.texcoords[v]));
        let size = Vec2::new(levels[0].width as f32, levels[0].height as f32);
        let texels = 0.5 * ((b - a) * size).perp_dot((c - a) * size).abs();
        let of_lookup = texels / (DIVISIONS * DIVISIONS) as f32;
        let level = (0.5 * of_lookup.max(1.0).log2()).round() as usize;
        &levels[level.min(levels.len() - 1)]
    }

    /// Mean of the normals at the corners, unit.
    fn normal(&self, corners: [usize; 3]) -> Vec3 {
        let sum: Vec3 = corners
            .map(|v| Vec3::from(self.scene.normals[v]))
            .into_iter()
            .sum();
        sum.normalize_or(Vec3::Y)
    }

    fn uv(&self, [a, b, c]: [usize; 3], [wa, wb, wc]: [f32; 3]) -> Vec2 {
        let uv = |v: usize| Vec2::from(self.scene.texcoords[v]);
        wa * uv(a) + wb * uv(b) + wc * uv(c)
    }

    fn colour(&self, [a, b, c]: [usize; 3], [wa, wb, wc]: [f32; 3]) -> [f32; 4] {
        if self.scene.colours.is_empty() {
            return [1.0; 4];
        }
        let share = |v: usize, i: usize| f32::from(self.scene.colours[v][i]) / f32::from(u16::MAX);
        std::array::from_fn(|i| wa * share(a, i) + wb * share(b, i) + wc * share(c, i))
    }
}

/// One point in each of the n² equal triangles into which parallels to the sides divide a triangle: its centre, or spread over it. Centres
/// would meet the bars of a fence all alike; other textures are as coarse as the triangles are.
fn barycentric_points(n: u32, spread: bool) -> impl Iterator<Item = [f32; 3]> {
    // Roberts' sequence R2: inverse of the plastic number, whose cube is one more than it, and its square.
    const STEP: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];
    let within = move |number: u32| {
        let [a, b] = STEP.map(|step| (0.5 + step * f64::from(number)).fract() as f32);
        match (spread, a + b > 1.0) {
            (false, _) => [1.0 / 3.0; 2],
            (true, true) => [1.0 - a, 1.0 - b],
            (true, false) => [a, b],
        }
    };
    let point = move |u: f32, v: f32| [1.0 - (u + v) / n as f32, u / n as f32, v / n as f32];
    (0..n).flat_map(move |i| {
        let upright = (0..n - i).map(move |j| {
            let [a, b] = within(2 * (i * n + j));
            point(i as f32 + a, j as f32 + b)
        });
        let inverted = (0..(n - i).saturating_sub(1)).map(move |j| {
            let [a, b] = within(2 * (i * n + j) + 1);
            point((i + 1) as f32 - a, (j + 1) as f32 - b)
        });
        upright.chain(inverted)
    })
}

/// The texel at texture coordinates.
fn nearest(texture: &Texture, uv: Vec2) -> [f32; 4] {
    let [u, v] = texture.wrap;
    let at = |v: f32, n: u32| (v * n as f32).floor() as i64;
    let x = u.texel(at(uv.x, texture.width), texture.width);
    let y = v.texel(at(uv.y, texture.height), texture.height);
    texture.linear(x, y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Bounds, Encoding, Part};

    /// A triangle over the lower left half of a texture, which repeats so often along its width.
    fn triangle(material: Material, size: [u32; 2], rgba8: Vec<u8>, repeats: f32) -> Scene {
        Scene {
            positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            normals: vec![[0.0, 0.0, 1.0]; 3],
            texcoords: vec![[0.0, 0.0], [repeats, 0.0], [0.0, 1.0]],
            indices: vec![0, 1, 2],
            parts: vec![Part {
                first_index: 0,
                index_count: 3,
                material: 0,
                has_colours: false,
                bounds: Bounds::EMPTY,
            }],
            materials: vec![material],
            textures: vec![Texture {
                name: "map".into(),
                width: size[0],
                height: size[1],
                rgba8,
                encoding: Encoding::Srgb,
                wrap: Default::default(),
            }],
            ..Scene::default()
        }
    }

    /// A triangle over the lower left half of a texture that is bright (sRGB 188, 0.503 in linear light) in its left half.
    #[test]
    fn the_mean_emission_is_that_of_the_part_of_the_texture_on_the_triangle() {
        let texels = (0..32u32 * 32).map(|i| if i % 32 < 16 { 188 } else { 0 });
        let lamp = Material {
            emission: [100.0, 50.0, 0.0],
            emissive_texture: Some(0),
            ..Material::default()
        };
        let rgba8 = texels.flat_map(|v: u8| [v, v, v, 255]).collect();
        let scene = triangle(lamp, [32, 32], rgba8, 1.0);
        let mean = Reflectances::new(&scene).of(0);
        // Three quarters of the triangle are in the left half.
        let expected = 0.75 * 0.5029 * 100.0;
        println!("{mean:?}, expected {expected}");
        assert!((mean.emission[0] / expected - 1.0).abs() < 0.01);
        assert!((mean.emission[1] / mean.emission[0] - 0.5).abs() < 1e-6);
        assert_eq!(
            (mean.emission[2], mean.diffuse, mean.opacity),
            (0.0, [0.5; 3], 1.0)
        );
    }

    #[test]
    fn the_points_are_spread_evenly() {
        for (spread, off) in [(false, 1e-5), (true, 0.01)] {
            let points: Vec<_> = barycentric_points(DIVISIONS, spread).collect();
            assert_eq!(points.len(), (DIVISIONS * DIVISIONS) as usize);
            for i in 0..3 {
                let mean = points.iter().map(|p| p[i]).sum::<f32>() / points.len() as f32;
                assert!((mean - 1.0 / 3.0).abs() < off, "{mean}");
            }
            assert!(points.iter().flatten().all(|w| *w > -1e-6));
        }
    }

    /// Bars of two texels in eight, repeated over a quad: regular lookups meet as many bars as gaps, or bars alone.
    #[test]
    fn a_fence_is_as_open_as_its_gaps() {
        for repeats in [0.5f32, 1.0, 2.0, 3.0, 6.0, 8.0, 12.0, 25.0] {
            let texels = (0..64u32).map(|i| if i % 8 < 2 { 255 } else { 0 });
            let bars = Material {
                diffuse_texture: Some(0),
                alpha_cutoff: Some(0.5),
                ..Material::default()
            };
            let rgba8 = texels.flat_map(|alpha: u8| [99, 99, 99, alpha]).collect();
            let scene = triangle(bars, [64, 1], rgba8, repeats);
            let opacity = Reflectances::new(&scene).of(0).opacity;
            assert!((opacity - 0.25).abs() < 0.06, "{repeats}: {opacity}");
        }
    }
}
