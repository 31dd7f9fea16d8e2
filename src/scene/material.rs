//! Materials with ρ_d, ρ_s and p of the lecture, L_e, and the conversion to them from metallic-roughness.

use serde::{Deserialize, Serialize};

use crate::scene::microfacet::{Microfacet, dielectric};

/// Reflectance of a surface, Lambertian plus a lobe of Phong or GGX, and the light that it emits. All surfaces are two-sided.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Name in the source file.
    pub name: String,
    /// Diffuse reflectance ρ_d (MTL `Kd`), linear RGB, 0..1; multiplied by `diffuse_texture` and vertex colours.
    pub diffuse: [f32; 3],
    /// Specular reflectance ρ_s (MTL `Ks`), linear RGB, 0..1; multiplied by `specular_texture`.
    pub specular: [f32; 3],
    /// Phong exponent p (MTL `Ns`), 1..100 000.
    pub shininess: f32,
    /// Opacity (MTL `d`, or 1 − `Tr`), 0..1. Materials below 0.5 without an `alpha_cutoff` are not drawn.
    pub dissolve: f32,
    /// For cut-outs, 0..1: fragments are discarded where `dissolve` x alpha of `diffuse_texture` x vertex alpha is lower.
    pub alpha_cutoff: Option<f32>,
    /// Index of the ρ_d texture in [`Scene::textures`](crate::scene::Scene::textures).
    pub diffuse_texture: Option<usize>,
    /// Index of the ρ_s texture in [`Scene::textures`](crate::scene::Scene::textures).
    pub specular_texture: Option<usize>,
    /// Index of the normal map in [`Scene::textures`](crate::scene::Scene::textures).
    pub normal_texture: Option<usize>,
    /// Factor on the slopes of the normal map.
    pub normal_scale: f32,
    /// Emitted radiance L_e, the same in all directions and on both sides (MTL `Ke`, `emissiveFactor` times strength of glTF), cd/m²,
    /// linear RGB, 0..[`MAX_EMISSION`]; multiplied by `emissive_texture`. A unit of a file is one cd/m².
    pub emission: [f32; 3],
    /// Index of the texture of L_e in [`Scene::textures`](crate::scene::Scene::textures).
    pub emissive_texture: Option<usize>,
    /// A pane of clear glass: its transmittance at normal incidence, linear RGB, 0..1, see [`crate::daylight::glass`]. It lets sun, sky
    /// and view through and mirrors the sky; it has no ρ_d.
    pub glass: Option<[f32; 3]>,
    /// Reflection by GGX instead of `diffuse`, `specular` and `shininess`, which are the same surface as the lecture's model has it.
    pub microfacet: Option<Microfacet>,
}

/// Largest emitted radiance, cd/m²: the largest number of the device's colours of 32 bits, and a twentieth of the sun.
pub const MAX_EMISSION: f32 = 65_408e3;

/// An emitted radiance within its range; black if it is no number.
pub(super) fn bounded_emission(rgb: [f32; 3]) -> [f32; 3] {
    rgb.map(|v| {
        if v.is_nan() {
            0.0
        } else {
            v.clamp(0.0, MAX_EMISSION)
        }
    })
}

/// Default material of models without materials: Lambertian, reflectance 0.5.
pub(super) const MTL_DEFAULT: Material = Material {
    name: String::new(),
    diffuse: [0.5; 3],
    specular: [0.0; 3],
    shininess: 1.0,
    dissolve: 1.0,
    alpha_cutoff: None,
    diffuse_texture: None,
    specular_texture: None,
    normal_texture: None,
    normal_scale: 1.0,
    emission: [0.0; 3],
    emissive_texture: None,
    glass: None,
    microfacet: None,
};

impl Default for Material {
    fn default() -> Self {
        MTL_DEFAULT.clone()
    }
}

/// A material as its name and the bit patterns of its values.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(super) struct MaterialKey {
    name: String,
    /// ρ_d, ρ_s, p, opacity, cut-off (negative if none), normal map factor, L_e, transmittance of glass (negative if none).
    values: [u32; 16],
    /// Base colour, F0, F90, metalness, roughness (negative if none).
    microfacet: [u32; 9],
    textures: [Option<usize>; 5],
}

impl Material {
    /// Equal for equal materials.
    pub(super) fn key(&self) -> MaterialKey {
        // Exhaustive, so that a new field does not compile until it is part of the key.
        let Self {
            name,
            diffuse: [r, g, b],
            specular: [sr, sg, sb],
            shininess,
            dissolve,
            alpha_cutoff,
            diffuse_texture,
            specular_texture,
            normal_texture,
            normal_scale,
            emission: [er, eg, eb],
            emissive_texture,
            glass,
            microfacet,
        } = self;
        let cutoff = alpha_cutoff.unwrap_or(-1.0);
        let [tr, tg, tb] = glass.unwrap_or([-1.0; 3]);
        let values = [
            *r,
            *g,
            *b,
            *sr,
            *sg,
            *sb,
            *shininess,
            *dissolve,
            cutoff,
            *normal_scale,
            *er,
            *eg,
            *eb,
            tr,
            tg,
            tb,
        ];
        let facets = microfacet.map_or([-1.0; 9], |m| {
            let ([r, g, b], [x, y, z]) = (m.base, m.f0);
            [r, g, b, x, y, z, m.f90, m.metallic, m.roughness]
        });
        MaterialKey {
            name: name.clone(),
            values: values.map(f32::to_bits),
            microfacet: facets.map(f32::to_bits),
            textures: [
                *diffuse_texture,
                *specular_texture,
                *normal_texture,
                *emissive_texture,
                microfacet.and_then(|m| m.texture),
            ],
        }
    }

    /// The diffuse reflectance by which it lights other surfaces, linear RGB, 0..1, without its texture.
    pub fn scattered(&self) -> [f32; 3] {
        self.microfacet.map_or(self.diffuse, |m| m.scattered())
    }

    /// Indices of its textures: ρ_d, ρ_s, normals, L_e, metalness and roughness.
    pub(super) fn textures(&self) -> [Option<usize>; 5] {
        [
            self.diffuse_texture,
            self.specular_texture,
            self.normal_texture,
            self.emissive_texture,
            self.microfacet.and_then(|m| m.texture),
        ]
    }

    /// Whether it emits light.
    pub fn is_emissive(&self) -> bool {
        self.emission != [0.0; 3]
    }

    /// Whether it is opaque enough to be drawn.
    pub(super) fn is_drawn(&self) -> bool {
        self.glass.is_some() || self.dissolve >= self.alpha_cutoff.unwrap_or(0.5)
    }
}

/// A number within 0..1; 0 if it is none.
pub(super) fn unit(v: f32) -> f32 {
    if v.is_finite() {
        v.clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// A surface in the metallic-roughness model of glTF and of the PBR extension of MTL.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MetallicRoughness {
    /// Base colour, linear RGB, 0..1.
    pub base: [f32; 3],
    /// 0 for dielectrics, 1 for metals.
    pub metallic: f32,
    /// Perceptual roughness, 0..1.
    pub roughness: f32,
    /// Index of refraction of the dielectric, at least 1.
    pub ior: f32,
    /// Factor on the reflectance of the dielectric, linear RGB.
    pub specular: [f32; 3],
}

/// Converts a metallic-roughness surface to ρ_d, ρ_s and p.
///
/// With F0 = ((ior − 1)/(ior + 1))² for dielectrics and the base colour for metals, and gloss g = (1 − roughness)²:
///
/// - ρ_s = g F0: ρ_s reflects the sky sharply for any p, so a rough surface, which would blur the sky, keeps only the
///   fraction g;
/// - ρ_d = base (1 − metallic g): a rough metal scatters the light it does not reflect specularly, tinted by its base
///   colour; a dielectric keeps its base colour;
/// - p = 2/α² − 2 with α = roughness² (Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces": the
///   Phong lobe of the same width), 1..100 000.
pub(super) fn phong_of(surface: &MetallicRoughness) -> ([f32; 3], [f32; 3], f32) {
    let (metallic, roughness) = (unit(surface.metallic), unit(surface.roughness));
    let gloss = (1.0 - roughness) * (1.0 - roughness);
    let dielectric = dielectric(surface.ior);
    let base = surface.base.map(unit);
    let diffuse = base.map(|b| b * (1.0 - metallic * gloss));
    let specular = std::array::from_fn(|i| {
        let f0 = dielectric * surface.specular[i];
        unit(gloss * (f0 + metallic * (base[i] - f0)))
    });
    let alpha = roughness * roughness;
    let shininess = (2.0 / (alpha * alpha).max(1e-6) - 2.0).clamp(1.0, 1e5);
    (diffuse, specular, shininess)
}

/// A surface in the specular-glossiness model of KHR_materials_pbrSpecularGlossiness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SpecularGlossiness {
    /// Diffuse colour, linear RGB, 0..1.
    pub diffuse: [f32; 3],
    /// Reflectance at normal incidence, linear RGB, 0..1.
    pub specular: [f32; 3],
    /// 1 − perceptual roughness, 0..1.
    pub glossiness: f32,
}

/// Reflectance at normal incidence of a dielectric of index 1.5.
pub(super) const DIELECTRIC: f32 = 0.04;

impl SpecularGlossiness {
    /// The share of the diffuse colour that is left beside the specular one: the specification has c_diff = diffuse (1 − max F0), and its
    /// conversion to a base colour divides by 1 − 0.04.
    pub fn diffuse_share(&self) -> f32 {
        let strongest = self.specular.into_iter().map(unit).fold(0.0, f32::max);
        ((1.0 - strongest) / (1.0 - DIELECTRIC)).min(1.0)
    }
}

/// Converts a specular-glossiness surface to ρ_d, ρ_s and p, by the rules of [`phong_of`]: ρ_s = g F0, and the diffuse colour
/// loses what is reflected beyond the reflectance of a dielectric. What a rough surface does not reflect specularly it scatters.
pub(super) fn phong_of_glossiness(surface: &SpecularGlossiness) -> ([f32; 3], [f32; 3], f32) {
    let specular = surface.specular.map(unit);
    let kept = surface.diffuse_share();
    let gloss = unit(surface.glossiness) * unit(surface.glossiness);
    let rough = MetallicRoughness {
        base: [0.0; 3],
        metallic: 0.0,
        roughness: 1.0 - unit(surface.glossiness),
        ior: 1.5,
        specular: [1.0; 3],
    };
    let (_, _, shininess) = phong_of(&rough);
    let scattered = |f0: f32| (1.0 - gloss) * (f0 - DIELECTRIC).max(0.0);
    let diffuse =
        std::array::from_fn(|i| unit(unit(surface.diffuse[i]) * kept + scattered(specular[i])));
    (diffuse, specular.map(|f0| gloss * f0), shininess)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glossiness_gives_what_roughness_gives() {
        let gloss = |diffuse, specular, glossiness| {
            phong_of_glossiness(&SpecularGlossiness {
                diffuse,
                specular,
                glossiness,
            })
        };
        let close = |a: ([f32; 3], [f32; 3], f32), b: ([f32; 3], [f32; 3], f32)| {
            let colours = a.0.iter().chain(&a.1).zip(b.0.iter().chain(&b.1));
            colours.into_iter().all(|(a, b)| (a - b).abs() < 1e-4) && (a.2 - b.2).abs() < 1e-3 * b.2
        };
        for roughness in [0.0, 0.3, 1.0] {
            let plastic = MetallicRoughness {
                roughness,
                ..PLASTIC
            };
            let own = gloss(PLASTIC.base, [0.04; 3], 1.0 - roughness);
            assert!(close(own, phong_of(&plastic)), "{roughness}: {own:?}");
        }
        let (diffuse, specular, _) = gloss([0.0; 3], [0.9, 0.6, 0.3], 1.0);
        assert_eq!(
            (diffuse, specular),
            ([0.0; 3], [0.9, 0.6, 0.3]),
            "a polished metal"
        );
        let (diffuse, ..) = gloss([0.0; 3], [0.9; 3], 0.0);
        assert!((diffuse[0] - 0.86).abs() < 1e-6, "a rough metal scatters");
        let (diffuse, specular, p) = gloss([f32::NAN; 3], [9.0; 3], f32::NAN);
        assert!(diffuse[0] <= 1.0 && specular[0] == 0.0 && p == 1.0);
    }

    const PLASTIC: MetallicRoughness = MetallicRoughness {
        base: [0.8, 0.4, 0.2],
        metallic: 0.0,
        roughness: 1.0,
        ior: 1.5,
        specular: [1.0; 3],
    };

    #[test]
    fn a_rough_dielectric_is_lambertian() {
        assert_eq!(phong_of(&PLASTIC), (PLASTIC.base, [0.0; 3], 1.0));
    }

    #[test]
    fn a_smooth_dielectric_reflects_four_percent() {
        let (diffuse, specular, shininess) = phong_of(&MetallicRoughness {
            roughness: 0.0,
            ..PLASTIC
        });
        assert_eq!(diffuse, PLASTIC.base);
        assert!(specular.iter().all(|s| (s - 0.04).abs() < 1e-6));
        assert_eq!(shininess, 1e5);
    }

    #[test]
    fn metals_share_their_colour_between_specular_and_diffuse() {
        for roughness in [0.0, 0.3, 0.7, 1.0] {
            let metal = MetallicRoughness {
                metallic: 1.0,
                roughness,
                ..PLASTIC
            };
            let (diffuse, specular, _) = phong_of(&metal);
            for i in 0..3 {
                assert!((diffuse[i] + specular[i] - metal.base[i]).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn invalid_values_give_bounded_ones() {
        let (diffuse, specular, shininess) = phong_of(&MetallicRoughness {
            base: [f32::NAN, 9.0, -1.0],
            metallic: f32::INFINITY,
            roughness: -3.0,
            ior: f32::NAN,
            specular: [1e30; 3],
        });
        let unit = |v: &f32| (0.0..=1.0).contains(v);
        assert!(
            diffuse.iter().chain(&specular).all(unit),
            "{diffuse:?} {specular:?}"
        );
        assert!((1.0..=1e5).contains(&shininess));
    }
}
