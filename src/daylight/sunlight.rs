//! The sun's disc through a clear atmosphere: five spectral transmittances, then lux and cd/m².
//!
//! Also the lecture's two simple estimates: Rayleigh's law of 1871 ([`rayleigh_1871`]) and the sun's broadband irradiance
//! ([`lecture_sun_irradiance`]).

use std::f64::consts::PI;
use std::ops::RangeInclusive;

use glam::{DVec2, DVec3, Vec3};

use super::colour;
use super::data::preetham_spectra as spectra;
use super::spectrum::{self, TabulatedSpectrum};

/// Diameter of the sun over its distance, from Preetham et al. 1999, A.1: 1.39e6 km and 150e6 km.
pub const SUN_DIAMETER_OVER_DISTANCE: f64 = 1.39 / 150.0;

/// Solid angle Ω of the sun's disc, sr: π/4 (1.39/150)² = 6.7443e-5.
pub const SUN_SOLID_ANGLE: f64 = PI / 4.0 * SUN_DIAMETER_OVER_DISTANCE * SUN_DIAMETER_OVER_DISTANCE;

/// Angular radius of the sun's disc, radians: 0.004633, that is 0.2655°.
pub const SUN_ANGULAR_RADIUS: f64 = SUN_DIAMETER_OVER_DISTANCE / 2.0;

/// Wavelengths covered by Preetham's table of the sun's radiance, nm.
pub const SUN_RANGE_NM: RangeInclusive<u32> = 380..=750;

/// Precipitable water vapour w, cm (Preetham et al. 1999, A.1).
pub const WATER_VAPOUR_CM: f64 = 2.0;

/// Amount of ozone, cm (Preetham et al. 1999, A.1: 0.35 cm at normal temperature and pressure).
pub const OZONE_CM: f64 = 0.35;

/// Unit vector toward a point of the sun's disc, uniformly distributed for `xi` uniform in the unit square. `centre` is the unit vector toward
/// its centre.
pub fn on_disc(centre: Vec3, xi: DVec2) -> Vec3 {
    let radius = (xi.x.sqrt() * SUN_ANGULAR_RADIUS) as f32;
    let angle = (xi.y * std::f64::consts::TAU) as f32;
    let (tangent, bitangent) = centre.any_orthonormal_pair();
    (centre + radius * (angle.cos() * tangent + angle.sin() * bitangent)).normalize()
}

/// Kasten 1966 (Preetham et al. 1999, A.1): relative optical mass m of the air, 1 at the zenith, about 37 at the horizon.
///
/// `elevation_deg` is the sun's elevation, -3.8..=90 degrees (clamped to the horizon, since the formula has a pole below).
pub fn air_mass(elevation_deg: f64) -> f64 {
    let elevation = elevation_deg.clamp(0.0, 90.0);
    let zenith = 90.0 - elevation;
    1.0 / (elevation.to_radians().sin() + 0.15 * (93.885 - zenith).powf(-1.253))
}

/// Preetham et al. 1999, A.1: Rayleigh scattering by air molecules, exp(-0.008735 m λ^-4.08), λ in µm.
///
/// m is a factor; it is not in the exponent of λ as the typesetting suggests.
pub fn rayleigh_transmittance(nm: f64, air_mass: f64) -> f64 {
    (-0.008735 * air_mass * micrometres(nm).powf(-4.08)).exp()
}

/// Preetham et al. 1999, A.1 (Ångström): aerosol extinction exp(-β m λ^-1.3), λ in µm, β from [`angstrom_beta`].
pub fn aerosol_transmittance(nm: f64, air_mass: f64, turbidity: f64) -> f64 {
    (-angstrom_beta(turbidity) * air_mass * micrometres(nm).powf(-1.3)).exp()
}

/// Preetham et al. 1999, A.1: Ångström's turbidity coefficient β for the turbidity T (0 at T ≈ 1, pure air).
///
/// The paper prints 0.04608 T - 0.04586; these are the digits of its authors' program.
pub fn angstrom_beta(turbidity: f64) -> f64 {
    0.046_083_658_220_5 * turbidity - 0.045_860_259_285_22
}

/// Preetham et al. 1999, A.1: ozone absorption exp(-0.35 k_o m).
pub fn ozone_transmittance(nm: f64, air_mass: f64) -> f64 {
    (-OZONE_CM * ozone_absorption(nm) * air_mass).exp()
}

/// Preetham et al. 1999, A.1: absorption by the mixed gases (mostly oxygen), exp(-1.41 k_g m / (1 + 118.93 k_g m)^0.45).
///
/// k_g begins at 760 nm, beyond the end of the table of the sun's radiance: it never affects a colour.
pub fn mixed_gas_transmittance(nm: f64, air_mass: f64) -> f64 {
    let km = mixed_gas_absorption(nm) * air_mass;
    (-1.41 * km / (1.0 + 118.93 * km).powf(0.45)).exp()
}

/// Preetham et al. 1999, A.1: absorption by water vapour, exp(-0.2385 k_wa w m / (1 + 20.07 k_wa w m)^0.45), w = 2 cm.
pub fn water_vapour_transmittance(nm: f64, air_mass: f64) -> f64 {
    let kwm = water_vapour_absorption(nm) * WATER_VAPOUR_CM * air_mass;
    (-0.2385 * kwm / (1.0 + 20.07 * kwm).powf(0.45)).exp()
}

/// Product of the five transmittances at `nm`, in 0..=1.
pub fn transmittance(nm: f64, air_mass: f64, turbidity: f64) -> f64 {
    rayleigh_transmittance(nm, air_mass)
        * aerosol_transmittance(nm, air_mass, turbidity)
        * ozone_transmittance(nm, air_mass)
        * mixed_gas_transmittance(nm, air_mass)
        * water_vapour_transmittance(nm, air_mass)
}

/// Preetham et al. 1999, table 2: radiance of the sun's disc outside the atmosphere at `nm`, W m⁻² nm⁻¹ sr⁻¹.
pub fn extraterrestrial_radiance(nm: f64) -> f64 {
    TabulatedSpectrum(spectra::SUN_RADIANCE).at(nm)
}

/// Preetham et al. 1999, table 2: absorption coefficient k_o of ozone at `nm`, 1/cm.
pub fn ozone_absorption(nm: f64) -> f64 {
    TabulatedSpectrum(spectra::OZONE).at(nm)
}

/// Preetham et al. 1999, table 2: absorption coefficient k_g of the mixed gases at `nm`, 1/cm.
pub fn mixed_gas_absorption(nm: f64) -> f64 {
    TabulatedSpectrum(spectra::MIXED_GASES).at(nm)
}

/// Preetham et al. 1999, table 2: absorption coefficient k_wa of water vapour at `nm`, 1/cm.
pub fn water_vapour_absorption(nm: f64) -> f64 {
    TabulatedSpectrum(spectra::WATER_VAPOUR).at(nm)
}

fn micrometres(nm: f64) -> f64 {
    nm / 1000.0
}

/// The sun's disc seen through the air (or without it), averaged over the disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sunlight {
    /// Luminance of the disc as XYZ, Y in cd/m².
    pub luminance_xyz: DVec3,
    /// Radiance of the disc in 380..=750 nm, W m⁻² sr⁻¹.
    pub radiance_w: f64,
}

impl Sunlight {
    /// Preetham et al. 1999, A.1: the disc seen at `elevation_deg` (0..=90) through air of `turbidity` (1..=10).
    pub fn new(turbidity: f64, elevation_deg: f64) -> Self {
        let mass = air_mass(elevation_deg);
        Self::from_spectrum(|nm| extraterrestrial_radiance(nm) * transmittance(nm, mass, turbidity))
    }

    /// The disc outside the atmosphere: 1.88e9 cd/m², 127 klux.
    pub fn extraterrestrial() -> Self {
        Self::from_spectrum(extraterrestrial_radiance)
    }

    fn from_spectrum(radiance: impl Fn(f64) -> f64) -> Self {
        Self {
            luminance_xyz: spectrum::xyz_from_spectrum(SUN_RANGE_NM, &radiance),
            radiance_w: spectrum::integral(SUN_RANGE_NM, &radiance),
        }
    }

    /// Luminance of the disc as linear BT.709 RGB, cd/m². A low sun is out of gamut: G and B below 0.
    pub fn luminance(&self) -> DVec3 {
        colour::rgb_from_xyz(self.luminance_xyz)
    }

    /// Illuminance at normal incidence as linear BT.709 RGB, lux: luminance times [`SUN_SOLID_ANGLE`].
    pub fn illuminance(&self) -> DVec3 {
        self.luminance() * SUN_SOLID_ANGLE
    }

    /// Irradiance at normal incidence in 380..=750 nm, W/m².
    pub fn irradiance_w(&self) -> f64 {
        self.radiance_w * SUN_SOLID_ANGLE
    }
}

/// Fraction of the sun's disc above the horizon when its centre is at `elevation_deg`, in 0..=1.
///
/// Area of a circular segment; 1/2 with the centre on the horizon.
pub fn visible_fraction(elevation_deg: f64) -> f64 {
    let h = (elevation_deg.to_radians() / SUN_ANGULAR_RADIUS).clamp(-1.0, 1.0);
    (0.5 + (h * (1.0 - h * h).sqrt() + h.asin()) / PI).clamp(0.0, 1.0)
}

/// Coefficient u of linear limb darkening, I = I₀ (1 − u (1 − cos θ)) (Allen, Astrophysical Quantities: 0.6 at 550 nm).
pub const LIMB_DARKENING: f64 = 0.6;

/// Linear limb darkening, see [`LIMB_DARKENING`]: luminance at the distance `r` from the disc's centre (0 centre, 1 limb)
/// relative to the disc's mean luminance; from 1.25 down to 0.5.
pub fn limb_darkening(r: f64) -> f64 {
    const U: f64 = LIMB_DARKENING;
    let mu = (1.0 - r * r).max(0.0).sqrt();
    (1.0 - U * (1.0 - mu)) / (1.0 - U / 3.0)
}

/// Rayleigh 1871, quoted on the lecture's first slide: I/I_0 = exp(-k λ⁻⁴ x) after the thickness `x` of a turbid medium.
///
/// `wavelength` in any unit, `k` in that unit to the fourth per unit of `x`.
pub fn rayleigh_1871(k: f64, wavelength: f64, x: f64) -> f64 {
    (-k * wavelength.powi(-4) * x).exp()
}

/// Power Φ that the sun radiates, W (lecture, "Direct sunlight").
pub const LECTURE_SUN_POWER: f64 = 3.91e26;

/// Surface area A of the sun, m² (lecture, "Direct sunlight").
pub const LECTURE_SUN_AREA: f64 = 6.07e18;

/// Distance r of the sun, m (lecture, "Direct sunlight").
pub const LECTURE_SUN_DISTANCE: f64 = 1.5e11;

/// Lecture, "Direct sunlight": radiance of the sun as a diffuse emitter, Φ/(πA) ≈ 2.05e7 W m⁻² sr⁻¹.
///
/// Broadband: see [`lecture_sun_irradiance`].
pub fn lecture_sun_radiance() -> f64 {
    LECTURE_SUN_POWER / (PI * LECTURE_SUN_AREA)
}

/// Lecture, "Direct sunlight": solid angle of the sun, A/(4 r²) ≈ 6.74e-5 sr.
pub fn lecture_sun_solid_angle() -> f64 {
    LECTURE_SUN_AREA / (4.0 * LECTURE_SUN_DISTANCE * LECTURE_SUN_DISTANCE)
}

/// Lecture, "Direct sunlight": irradiance outside the atmosphere, L ω ≈ 1383 W/m².
///
/// This is power over *all* wavelengths. It must not be multiplied by 683 lm/W, which holds at 555 nm only: that would give
/// 945 klux, while the spectrum gives 127 klux ([`Sunlight::extraterrestrial`], some 92 lm/W).
pub fn lecture_sun_irradiance() -> f64 {
    lecture_sun_radiance() * lecture_sun_solid_angle()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::colour::luminance;
    use crate::daylight::sampling;

    #[test]
    fn the_disc_is_covered_and_not_left() {
        let centre = Vec3::new(0.3, 0.5, -0.8).normalize();
        let angles: Vec<f64> = (0..1000)
            .map(|i| f64::from(on_disc(centre, sampling::r2(i)).cross(centre).length()).asin())
            .collect();
        let largest = angles.iter().copied().fold(0.0, f64::max);
        assert!(largest <= SUN_ANGULAR_RADIUS * 1.001 && largest > SUN_ANGULAR_RADIUS * 0.97);
        // Uniform over the disc: half of the points lie within 1/sqrt(2) of the radius.
        let inner = angles
            .iter()
            .filter(|a| **a < SUN_ANGULAR_RADIUS / 2f64.sqrt())
            .count();
        assert!((450..550).contains(&inner), "{inner}");
    }

    #[test]
    fn rayleigh_blue_is_lost_first() {
        assert_eq!(rayleigh_1871(1.0, 0.55, 0.0), 1.0);
        // At half the wavelength scattering is 16 times stronger: exp(-16 a) = exp(-a)^16.
        let (short, long) = (
            rayleigh_1871(0.01, 0.35, 1.0),
            rayleigh_1871(0.01, 0.70, 1.0),
        );
        assert!((short - long.powi(16)).abs() < 1e-12, "{short} {long}");
        // dI = -k I λ⁻⁴ dx
        let (k, nm, x, dx) = (0.008, 0.45, 2.0, 1e-6);
        let slope = (rayleigh_1871(k, nm, x + dx) - rayleigh_1871(k, nm, x - dx)) / (2.0 * dx);
        assert!((slope + k * rayleigh_1871(k, nm, x) / nm.powi(4)).abs() < 1e-9);
    }

    #[test]
    fn the_lectures_numbers() {
        assert!((lecture_sun_radiance() / 2.05e7 - 1.0).abs() < 1e-3);
        assert!((lecture_sun_solid_angle() / 6.74e-5 - 1.0).abs() < 1e-3);
        assert!((lecture_sun_irradiance() - 1383.0).abs() < 1.0);
        let lux = luminance(Sunlight::extraterrestrial().illuminance());
        let efficacy = lux / lecture_sun_irradiance();
        assert!(
            (90.0..95.0).contains(&efficacy),
            "{efficacy} lm/W, far from 683"
        );
    }

    #[test]
    fn no_air_no_loss() {
        for nm in (380..=750).step_by(10) {
            assert_eq!(transmittance(f64::from(nm), 0.0, 3.0), 1.0);
        }
        assert!((air_mass(90.0) - 1.0).abs() < 1e-3);
        assert!((30.0..40.0).contains(&air_mass(0.0)));
        assert_eq!(air_mass(-30.0), air_mass(0.0));
    }

    #[test]
    fn the_disc_sets_smoothly() {
        let radius = SUN_ANGULAR_RADIUS.to_degrees();
        assert_eq!(visible_fraction(2.0 * radius), 1.0);
        assert!((visible_fraction(0.0) - 0.5).abs() < 1e-15);
        assert!(visible_fraction(-radius) < 1e-12);
        assert!((visible_fraction(0.1) + visible_fraction(-0.1) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn limb_darkening_keeps_the_mean() {
        let rings = 10_000;
        let mean: f64 = (0..rings)
            .map(|i| limb_darkening(((f64::from(i) + 0.5) / f64::from(rings)).sqrt()))
            .sum::<f64>()
            / f64::from(rings);
        assert!((mean - 1.0).abs() < 1e-5, "{mean}");
    }
}
