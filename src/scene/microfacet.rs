//! Materials that reflect by GGX ([`crate::daylight::microfacet`]): those of glTF.

use serde::{Deserialize, Serialize};

use crate::scene::material::{DIELECTRIC, MetallicRoughness, SpecularGlossiness, unit};

/// Reflectance of a surface of microfacets over a diffuse one.
///
/// With b the base colour and m how far it is a metal: ρ_d = b (1 − m), F0 = f0 (1 − m) + b m, F90 = f90 (1 − m) + m.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Microfacet {
    /// Base colour b, linear RGB, 0..1; multiplied by the texture of ρ_d and vertex colours.
    pub base: [f32; 3],
    /// Reflectance F0 of the dielectric at normal incidence, linear RGB, 0..1.
    pub f0: [f32; 3],
    /// Reflectance F90 of the dielectric at grazing incidence, 0..1.
    pub f90: f32,
    /// Metalness m, 0..1; multiplied by the blue of `texture`.
    pub metallic: f32,
    /// Perceptual roughness, 0..1, of which the square is α; multiplied by the green of `texture`.
    pub roughness: f32,
    /// Index of the texture of both in [`Scene::textures`](crate::scene::Scene::textures).
    pub texture: Option<usize>,
}

/// Reflectance at normal incidence of a dielectric of this index of refraction (Fresnel).
pub(super) fn dielectric(ior: f32) -> f32 {
    let ior = if ior >= 1.0 { ior } else { 1.5 };
    ((ior - 1.0) / (ior + 1.0)).powi(2)
}

impl Microfacet {
    /// Of a metallic-roughness surface. glTF 2.0, appendix B, KHR_materials_ior and _specular: F0 = ((ior − 1)/(ior + 1))² times the
    /// specular colour, F90 the specular factor.
    pub(super) fn of_metallic_roughness(surface: &MetallicRoughness, f90: f32) -> Self {
        let f0 = dielectric(surface.ior);
        Self {
            base: surface.base.map(unit),
            f0: surface.specular.map(|specular| unit(f0 * specular)),
            f90: unit(f90),
            metallic: unit(surface.metallic),
            roughness: unit(surface.roughness),
            texture: None,
        }
    }

    /// Of a specular-glossiness surface. Its diffuse colour loses what is reflected beyond the reflectance of a dielectric, as the
    /// specification converts it to a base colour.
    pub(super) fn of_glossiness(surface: &SpecularGlossiness) -> Self {
        let kept = surface.diffuse_share();
        Self {
            base: surface.diffuse.map(|v| unit(unit(v) * kept)),
            f0: surface.specular.map(unit),
            f90: 1.0,
            metallic: 0.0,
            roughness: 1.0 - unit(surface.glossiness),
            texture: None,
        }
    }

    /// What other surfaces get of the light that it reflects, as if it scattered all of it: the base colour, of a metal too, and what the
    /// specular colour has beyond a dielectric's.
    pub fn scattered(&self) -> [f32; 3] {
        std::array::from_fn(|i| unit(self.base[i] + (self.f0[i] - DIELECTRIC).max(0.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reflectance_comes_from_the_index_of_refraction_and_the_specular_colour() {
        let glaze = MetallicRoughness {
            base: [0.2, 0.3, 0.4],
            metallic: 0.0,
            roughness: 0.4,
            ior: 1.5,
            specular: [1.0, 0.5, 0.0],
        };
        let own = Microfacet::of_metallic_roughness(&glaze, 0.5);
        let f0 = own.f0.map(|v| (v * 1e4).round());
        assert_eq!((f0, own.f90), ([400.0, 200.0, 0.0], 0.5));
        assert_eq!((own.base, own.roughness), (glaze.base, 0.4));
        assert_eq!(own.scattered(), glaze.base);
        let ior = |ior| MetallicRoughness { ior, ..glaze };
        let of = |ior_of| Microfacet::of_metallic_roughness(&ior(ior_of), 1.0).f0[0];
        assert!((of(2.0) - 1.0 / 9.0).abs() < 1e-6 && of(1.0) == 0.0);
        assert_eq!(of(f32::NAN), of(1.5));
    }

    #[test]
    fn glossiness_reflects_its_specular_colour() {
        let gold = SpecularGlossiness {
            diffuse: [0.5; 3],
            specular: [1.0, 0.7, 0.3],
            glossiness: 0.9,
        };
        let own = Microfacet::of_glossiness(&gold);
        assert_eq!(
            (own.base, own.f0, own.metallic),
            ([0.0; 3], gold.specular, 0.0)
        );
        assert!((own.roughness - 0.1).abs() < 1e-6);
        assert!((own.scattered()[1] - 0.66).abs() < 1e-6);
    }

    #[test]
    fn unusable_numbers_are_bounded() {
        let wild = MetallicRoughness {
            base: [f32::NAN, 9.0, -1.0],
            metallic: f32::INFINITY,
            roughness: -3.0,
            ior: f32::INFINITY,
            specular: [1e30; 3],
        };
        let own = Microfacet::of_metallic_roughness(&wild, f32::NAN);
        let others = [own.f90, own.metallic, own.roughness];
        let mut numbers = own.base.iter().chain(&own.f0).chain(&others);
        assert!(numbers.all(|v| (0.0..=1.0).contains(v)), "{own:?}");
    }
}
