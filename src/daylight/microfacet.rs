//! Light that a rough surface reflects: the lobe of GGX with its shadows, its albedo, and what it loses.
//!
//! f(v, l) = F(v·h) D(h) G₂(v, l) / (4 (n·v) (n·l)) · gain(v), with D of [`super::ggx::distribution`], α = roughness². F is Schlick's,
//! F0 + (F90 − F0) (1 − v·h)⁵ (Schlick 1994). Directions are about +Z, which is the normal.
//!
//! A single reflection loses what the facets shade of each other, up to half of the light at roughness 1. The gain returns it: Turquin
//! 2019, *Practical multiple scattering compensation for microfacet models*, eq. 16. A surface of F0 = 1 reflects all light.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::ggx::distribution;

/// Least α of the lobe of a source as wide as the sun: its mirror image is as wide as the disc. Roughness 0.05.
pub const LEAST_ALPHA: f64 = 0.0025;

/// Heitz 2014, *Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs*, eq. 72: Λ of a direction at this cosine
/// from the normal.
fn lambda(alpha: f64, cosine: f64) -> f64 {
    let tan2 = (1.0 - cosine * cosine).max(0.0) / (cosine * cosine).max(1e-12);
    0.5 * ((1.0 + alpha * alpha * tan2).sqrt() - 1.0)
}

/// Heitz 2014, eq. 99: the part of the facets seen from both directions, at these cosines from the normal; heights are correlated.
fn seen_from_both(alpha: f64, v: f64, l: f64) -> f64 {
    1.0 / (1.0 + lambda(alpha, v) + lambda(alpha, l))
}

/// f(v, l)/F without the gain, 1/sr; 0 if either direction is below the surface.
pub fn lobe(alpha: f64, v: DVec3, l: DVec3) -> f64 {
    if v.z <= 0.0 || l.z <= 0.0 {
        return 0.0;
    }
    let h = (v + l).normalize();
    distribution(alpha, h.z) * seen_from_both(alpha, v.z, l.z) / (4.0 * v.z * l.z)
}

/// Dupuy and Benyoub 2023, *Sampling Visible GGX Normals with Spherical Caps*: a normal h with the density of those seen from v, for
/// xi in [0, 1)².
pub fn visible_normal(alpha: f64, v: DVec3, xi: DVec2) -> DVec3 {
    let stretch = DVec3::new(alpha, alpha, 1.0);
    let seen = (v * stretch).normalize();
    let z = (1.0 - xi.y) * (1.0 + seen.z) - seen.z;
    let (sin, cos) = (2.0 * PI * xi.x).sin_cos();
    let sine = (1.0 - z * z).max(0.0).sqrt();
    ((DVec3::new(sine * cos, sine * sin, z) + seen) * stretch).normalize()
}

/// f(v, l) (n·l)/F without the gain over the density of l by [`visible_normal`], G₂/G₁; 0 if l is below the surface.
pub fn weight(alpha: f64, v: f64, l: f64) -> f64 {
    if l <= 0.0 {
        return 0.0;
    }
    (1.0 + lambda(alpha, v)) * seen_from_both(alpha, v, l)
}

/// Reflectance of a surface toward an eye under uniform light without the gain, by the parts of F0 and of F90: F0 of one, F90 of the
/// other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Albedo {
    /// Factor of F0.
    pub facing: f64,
    /// Factor of F90.
    pub grazing: f64,
}

/// Nodes of the sum, in azimuth and in the other dimension of the visible normals.
const NODES: [u32; 2] = [24, 64];

impl Albedo {
    /// Of a roughness and the cosine n·v > 0: the mean of [`weight`] over the visible normals.
    pub fn of(roughness: f64, cosine: f64) -> Self {
        let alpha = roughness * roughness;
        let v = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
        let (mut all, mut at_grazing, mut count) = (0.0, 0.0, 0.0);
        for i in 0..NODES[0] {
            for j in 0..NODES[1] {
                // Half of the azimuths: the other half is its mirror image.
                let x = 0.5 * (f64::from(i) + 0.5) / f64::from(NODES[0]);
                // Denser toward both ends, where the weight changes fast: y = s²(3 − 2s).
                let s = (f64::from(j) + 0.5) / f64::from(NODES[1]);
                let (y, step) = (s * s * (3.0 - 2.0 * s), s * (1.0 - s));
                let h = visible_normal(alpha, v, DVec2::new(x, y));
                let along = v.dot(h).max(0.0);
                let weight = step * weight(alpha, cosine, 2.0 * along * h.z - cosine);
                all += weight;
                at_grazing += weight * (1.0 - along).powi(5);
                count += step;
            }
        }
        Self {
            facing: (all - at_grazing) / count,
            grazing: at_grazing / count,
        }
    }

    /// What one reflection returns if F is 1.
    pub fn single(self) -> f64 {
        self.facing + self.grazing
    }

    /// Turquin 2019, eq. 16: the factor for the light that is reflected more than once.
    pub fn gain(self, f0: f64) -> f64 {
        1.0 + f0 * (1.0 / self.single() - 1.0)
    }

    /// All that the lobe reflects of uniform light toward the eye.
    pub fn reflectance(self, f0: f64, f90: f64) -> f64 {
        (f0 * self.facing + f90 * self.grazing) * self.gain(f0)
    }
}

/// Columns of the table, by √(n·v), and rows, by roughness; both go from 0 to 1.
pub const TABLE: [u32; 2] = [64, 32];

/// Least cosine of the table.
const LEAST_COSINE: f64 = 1e-4;

/// [`Albedo`] at every column and row, rows first: the other factor of the split sum (Karis 2013).
pub fn table() -> Vec<[f32; 2]> {
    let at = |i: u32, count: u32| f64::from(i) / f64::from(count - 1);
    let texel = |k: u32| {
        let (column, row) = (k % TABLE[0], k / TABLE[0]);
        let cosine = at(column, TABLE[0]).powi(2).max(LEAST_COSINE);
        let albedo = Albedo::of(at(row, TABLE[1]), cosine);
        [albedo.facing as f32, albedo.grazing as f32]
    };
    (0..TABLE[0] * TABLE[1]).map(texel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::sampling::r2;

    /// The table between its nodes, as the device looks it up.
    fn interpolated(table: &[[f32; 2]], roughness: f64, cosine: f64) -> Albedo {
        let place = |x: f64, count: u32| {
            let at = x * f64::from(count - 1);
            let low = at.floor().min(f64::from(count - 2));
            (low as usize, at - low)
        };
        let (column, x) = place(cosine.sqrt(), TABLE[0]);
        let (row, y) = place(roughness, TABLE[1]);
        let value = |k: usize| {
            let at = |c: usize, r: usize| f64::from(table[r * TABLE[0] as usize + c][k]);
            let line = |r: usize| at(column, r) * (1.0 - x) + at(column + 1, r) * x;
            line(row) * (1.0 - y) + line(row + 1) * y
        };
        Albedo {
            facing: value(0),
            grazing: value(1),
        }
    }

    /// ∫ lobe(v, l) F(v·h) (n·l) dl without the gain, over normals h of the density D (n·h): dl = 4 (v·h) dh.
    fn integral(alpha: f64, v: DVec3, fresnel: impl Fn(f64) -> f64) -> f64 {
        let (rings, turns) = (400, 96);
        let mut sum = 0.0;
        for i in 0..rings {
            let x = (f64::from(i) + 0.5) / f64::from(rings);
            let (xi, step) = (x * x * (3.0 - 2.0 * x), 6.0 * x * (1.0 - x));
            let cosine = ((1.0 - xi) / (1.0 + (alpha * alpha - 1.0) * xi)).sqrt();
            let sine = (1.0 - cosine * cosine).sqrt();
            for k in 0..turns {
                let (s, c) = (PI * (f64::from(k) + 0.5) / f64::from(turns)).sin_cos();
                let h = DVec3::new(c * sine, s * sine, cosine);
                let along = v.dot(h);
                let l = 2.0 * along * h - v;
                if along > 0.0 {
                    let density = distribution(alpha, cosine) * cosine / (4.0 * along);
                    sum += step * lobe(alpha, v, l) * fresnel(along) * l.z.max(0.0) / density;
                }
            }
        }
        sum / f64::from(rings * turns)
    }

    fn toward(cosine: f64) -> DVec3 {
        DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine)
    }

    #[test]
    fn the_albedo_is_the_integral_over_the_lobe() {
        for roughness in [0.05, 0.1, 0.3, 0.5, 0.7, 1.0f64] {
            for cosine in [0.05, 0.2, 0.5, 0.9, 1.0] {
                let (alpha, v) = (roughness * roughness, toward(cosine));
                let albedo = Albedo::of(roughness, cosine);
                for (f0, f90) in [(1.0, 1.0), (0.04, 1.0), (0.5, 0.0)] {
                    let fresnel = |along: f64| f0 + (f90 - f0) * (1.0 - along).powi(5);
                    let expected = integral(alpha, v, fresnel);
                    let found = f0 * albedo.facing + f90 * albedo.grazing;
                    let error = found / expected - 1.0;
                    assert!(error.abs() < 5e-3, "{roughness} {cosine} {f0} {error}");
                }
            }
        }
    }

    /// The white furnace: the lobe that the device draws, with its table, reflects all light if F0 = 1.
    #[test]
    fn a_white_metal_reflects_all_light() {
        let table = table();
        let mut worst = (0.0f64, 0.0, 0.0);
        let roughnesses = (0..39).map(|k| 0.05 + 0.025 * f64::from(k));
        for roughness in roughnesses {
            for degrees in [0.0, 10.0, 30.0, 50.0, 65.0, 75.0, 82.0, 86.0, 88.0, 89.0f64] {
                let cosine = degrees.to_radians().cos();
                let gain = interpolated(&table, roughness, cosine).gain(1.0);
                let sum = gain * integral(roughness * roughness, toward(cosine), |_| 1.0);
                if (sum - 1.0).abs() > worst.0.abs() {
                    worst = (sum - 1.0, roughness, degrees);
                }
            }
        }
        println!(
            "worst {:.2} % at roughness {:.3}, {}°",
            100.0 * worst.0,
            worst.1,
            worst.2
        );
        assert!(worst.0.abs() < 1e-2, "{worst:?}");
    }

    #[test]
    fn no_surface_reflects_more_than_it_gets() {
        for k in 0..500 {
            let [roughness, cosine] = r2(k).to_array();
            let albedo = Albedo::of(roughness, cosine.max(1e-3));
            for (f0, f90) in [(0.0, 1.0), (0.04, 1.0), (0.5, 1.0), (1.0, 1.0), (0.3, 0.3)] {
                let all = albedo.reflectance(f0, f90);
                assert!(
                    (0.0..1.0 + 1e-9).contains(&all),
                    "{roughness} {cosine} {f0} {all}"
                );
            }
        }
    }

    #[test]
    fn the_lobe_is_the_same_both_ways() {
        let (v, l) = (toward(0.3), DVec3::new(-0.2, 0.5, 0.7).normalize());
        assert!((lobe(0.4, v, l) / lobe(0.4, l, v) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_smooth_surface_is_a_mirror() {
        let (v, albedo) = (toward(0.6), Albedo::of(0.0, 0.6));
        assert_eq!(visible_normal(0.0, v, DVec2::new(0.3, 0.8)), DVec3::Z);
        assert!((albedo.single() - 1.0).abs() < 1e-12);
        assert!((albedo.grazing - 0.4f64.powi(5)).abs() < 1e-9);
    }
}
