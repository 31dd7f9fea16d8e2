//! The air as a medium: densities by altitude, scattering and absorption at four wavelengths, phase functions.

use std::f64::consts::PI;
use std::sync::LazyLock;

use glam::{DVec3, DVec4};

use super::air::Air;
use crate::daylight::data::atmosphere::{AIR_DENSITY, FIRST_NM, OZONE_CROSS_SECTION};

/// Radius of the ground, a sphere at sea level, km.
pub const GROUND_RADIUS: f64 = 6371.0;
/// Thickness of the air, km.
pub const THICKNESS: f64 = 120.0;
/// Radius of the top of the air, km.
pub const TOP_RADIUS: f64 = GROUND_RADIUS + THICKNESS;

/// Molecules in a cubic metre of air at sea level (288.15 K, 1013.25 hPa; Bodhaine et al. 1999).
const NUMBER_DENSITY: f64 = 2.546_899e25;
/// Molecules of ozone in a Dobson unit, 1/m².
const DOBSON_UNIT: f64 = 2.687e20;
/// Ozone lies between 10 and 40 km with its peak at this altitude, km; the tent holds as much as 15 km of the peak.
pub const OZONE_PEAK: f64 = 25.0;
/// Half of the tent, km.
pub const OZONE_HALF_WIDTH: f64 = 15.0;
/// Altitudes where the profile of ozone has kinks, km.
pub const OZONE_KINKS: [f64; 3] = [
    OZONE_PEAK - OZONE_HALF_WIDTH,
    OZONE_PEAK,
    OZONE_PEAK + OZONE_HALF_WIDTH,
];
/// Bucholtz 1995: γ of the anisotropy of air molecules in Chandrasekhar's phase function.
const RAYLEIGH_GAMMA: f64 = 0.0144;

/// Altitude between two entries of [`LN_AIR_DENSITY`], km.
pub const DENSITY_STEP: f64 = 2.0;

/// Logarithms of the density of the air over that at sea level (US Standard Atmosphere 1976), each [`DENSITY_STEP`].
pub static LN_AIR_DENSITY: LazyLock<[f64; 61]> = LazyLock::new(|| AIR_DENSITY.map(f64::ln));

/// Densities at an altitude in km (0..=120) over their reference: air and aerosol at sea level, ozone at its peak.
pub fn densities(altitude: f64, scale_height: f64) -> DVec3 {
    let at = altitude.clamp(0.0, THICKNESS) / DENSITY_STEP;
    // A small whole number, at most 59.
    let i = (at as usize).min(AIR_DENSITY.len() - 2);
    let [low, high] = [LN_AIR_DENSITY[i], LN_AIR_DENSITY[i + 1]];
    DVec3::new(
        (low + (high - low) * (at - i as f64)).exp(),
        (-altitude / scale_height).exp(),
        (1.0 - (altitude - OZONE_PEAK).abs() / OZONE_HALF_WIDTH).max(0.0),
    )
}

/// Bodhaine et al. 1999, eq. 29: scattering coefficient of air at sea level at `nm`, 1/km, King's factor included.
pub fn rayleigh_scattering(nm: f64) -> f64 {
    let square = (nm / 1000.0).powi(2);
    let cross_section = 1e-32 * (1.045_599_6 - 341.290_61 / square - 0.902_308_50 * square)
        / (1.0 + 0.002_705_988_9 / square - 85.968_563 * square);
    cross_section * NUMBER_DENSITY * 1000.0
}

/// Absorption cross-section of ozone at `nm`, m²; linear between the means of 10 nm.
fn ozone_cross_section(nm: f64) -> f64 {
    let at = ((nm - FIRST_NM) / 10.0).clamp(0.0, 39.0);
    let i = (at as usize).min(38);
    let [low, high] = [OZONE_CROSS_SECTION[i], OZONE_CROSS_SECTION[i + 1]];
    1e-25 * (low + (high - low) * (at - i as f64))
}

/// Coefficients of the air at four wavelengths at the reference densities, 1/km, and its phase functions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// Scattering by molecules.
    pub rayleigh: DVec4,
    /// Extinction by the aerosol.
    pub aerosol: DVec4,
    /// Absorption by ozone.
    pub ozone: DVec4,
    /// Share of the aerosol's extinction that is scattering, 0.8..=1.
    pub single_scattering_albedo: f64,
    /// g of Henyey and Greenstein.
    pub asymmetry: f64,
    /// Scale height of the aerosol, km.
    pub scale_height: f64,
    /// Diffuse reflectance of the ground.
    pub ground_albedo: f64,
}

impl Medium {
    /// The medium of `air` at four wavelengths in nm.
    pub fn new(air: &Air, nm: DVec4) -> Self {
        let aerosol = &air.aerosol;
        let height = aerosol.scale_height_km;
        assert!(
            (0.8..=1.0).contains(&aerosol.single_scattering_albedo),
            "scattering and extinction are mistaken for each other"
        );
        let ozone_peak = air.ozone_du * DOBSON_UNIT / (OZONE_HALF_WIDTH * 1000.0);
        let aerosol_ground = air.aod / (height * (1.0 - (-THICKNESS / height).exp()));
        let each = |f: &dyn Fn(f64) -> f64| DVec4::from_array(nm.to_array().map(f));
        Self {
            rayleigh: each(&rayleigh_scattering),
            aerosol: each(&|nm| aerosol_ground * (nm / 550.0).powf(-aerosol.angstrom)),
            ozone: each(&|nm| ozone_peak * ozone_cross_section(nm) * 1000.0),
            single_scattering_albedo: aerosol.single_scattering_albedo,
            asymmetry: aerosol.asymmetry,
            scale_height: height,
            ground_albedo: air.ground_albedo,
        }
    }

    /// Scattering by the aerosol at sea level, 1/km.
    pub fn aerosol_scattering(&self) -> DVec4 {
        self.aerosol * self.single_scattering_albedo
    }

    /// Optical depth of columns of air, aerosol and ozone in km at their reference densities.
    pub fn optical_depth(&self, columns: DVec3) -> DVec4 {
        self.rayleigh * columns.x + self.aerosol * columns.y + self.ozone * columns.z
    }

    /// Henyey & Greenstein 1941: share of the aerosol's scattered light per sr at the cosine of the scattering angle.
    pub fn aerosol_phase(&self, cosine: f64) -> f64 {
        let g = self.asymmetry;
        (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * cosine).powf(1.5))
    }
}

/// Chandrasekhar 1950 with γ of Bucholtz 1995: share of the light scattered by molecules per sr at the cosine of the scattering angle.
pub fn rayleigh_phase(cosine: f64) -> f64 {
    let g = RAYLEIGH_GAMMA;
    3.0 / (16.0 * PI * (1.0 + 2.0 * g)) * ((1.0 + 3.0 * g) + (1.0 - g) * cosine * cosine)
}

/// Moments of [`rayleigh_phase`]: ∫ p P_l dω for l = 0, 1, 2; the others are 0.
pub const RAYLEIGH_MOMENTS: [f64; 3] = [
    1.0,
    0.0,
    (1.0 - RAYLEIGH_GAMMA) / (10.0 * (1.0 + 2.0 * RAYLEIGH_GAMMA)),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::quadrature::gauss_legendre;

    #[test]
    fn phase_functions_share_out_all_light() {
        let medium = Medium::new(&Air::default(), DVec4::splat(550.0));
        let moment = |l: usize, phase: &dyn Fn(f64) -> f64| -> f64 {
            let legendre = [|_| 1.0, |c: f64| c, |c: f64| 1.5 * c * c - 0.5][l];
            let sum = gauss_legendre(200).into_iter().map(|(x, weight)| {
                let c = 2.0 * x - 1.0;
                4.0 * PI * weight * phase(c) * legendre(c)
            });
            sum.sum()
        };
        for (l, expected) in RAYLEIGH_MOMENTS.iter().enumerate() {
            let rayleigh = moment(l, &rayleigh_phase) - expected;
            let aerosol = moment(l, &|c| medium.aerosol_phase(c)) - 0.76f64.powi(l as i32);
            assert!(rayleigh.abs() < 1e-12 && aerosol.abs() < 1e-12, "{l}");
        }
    }

    #[test]
    fn the_coefficients_are_the_published_ones() {
        // Bodhaine et al. 1999, table 3: 4.5102e-27 cm² at 550 nm for dry air of 288.15 K.
        let cross_section = rayleigh_scattering(550.0) / (NUMBER_DENSITY * 1000.0);
        assert!(
            (cross_section / 4.5102e-31 - 1.0).abs() < 5e-3,
            "{cross_section:e}"
        );
        let medium = Medium::new(&Air::default(), DVec4::splat(550.0));
        // The optical depths that the user asked for.
        let height = medium.scale_height * (1.0 - (-THICKNESS / medium.scale_height).exp());
        assert!((medium.aerosol.x * height - 0.1).abs() < 1e-12);
        let ozone = medium.ozone.x * OZONE_HALF_WIDTH;
        assert!(
            (ozone / (300.0 * 2.687e20 * 3.2955e-25) - 1.0).abs() < 1e-3,
            "{ozone}"
        );
    }

    #[test]
    #[should_panic(expected = "mistaken")]
    fn scattering_is_not_absorption() {
        let mut air = Air::default();
        air.aerosol.single_scattering_albedo = 0.1;
        Medium::new(&air, DVec4::splat(550.0));
    }
}
