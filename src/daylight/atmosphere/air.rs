//! The air as the user describes it: aerosol, ozone, the observer's altitude, the ground's reflectance.

use std::ops::RangeInclusive;

use crate::daylight::sunlight::angstrom_beta;

/// Aerosol optical depths at 550 nm for which the solution holds; 0.6 is a visibility of 8 km.
pub const AOD_RANGE: RangeInclusive<f64> = 0.0..=0.6;
/// Visibilities, km: those of [`AOD_RANGE`] with the default scale height.
pub const VISIBILITY_RANGE_KM: RangeInclusive<f64> = 8.0..=300.0;
/// Turbidities T: those of [`AOD_RANGE`].
pub const TURBIDITY_RANGE: RangeInclusive<f64> = 1.0..=6.9;
/// Ozone, Dobson units.
pub const OZONE_RANGE_DU: RangeInclusive<f64> = 0.0..=600.0;
/// Altitudes of the observer above the sea, metres.
pub const ALTITUDE_RANGE_M: RangeInclusive<f64> = 0.0..=10_000.0;
/// Single-scattering albedos of the aerosol. A smaller number is a mistake for its complement, the share that is absorbed.
pub const SINGLE_SCATTERING_ALBEDO_RANGE: RangeInclusive<f64> = 0.8..=1.0;
/// Asymmetries of the aerosol's phase function.
pub const ASYMMETRY_RANGE: RangeInclusive<f64> = 0.0..=0.85;
/// Scale heights of the aerosol, km.
pub const SCALE_HEIGHT_RANGE_KM: RangeInclusive<f64> = 0.5..=8.0;
/// Ångström exponents of the aerosol.
pub const ANGSTROM_RANGE: RangeInclusive<f64> = 0.0..=2.5;
/// Reflectances of the ground.
pub const GROUND_ALBEDO_RANGE: RangeInclusive<f64> = 0.0..=1.0;

/// Extinction of pure air at 550 nm at sea level, 1/km, in Koschmieder's law of visibility.
const AIR_EXTINCTION: f64 = 0.0115;
/// Koschmieder 1924: -ln 0.02, the optical depth at which black is seen as background.
const KOSCHMIEDER: f64 = 3.912;

/// What floats in the air: shape, absorption, height and colour of the aerosol.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aerosol {
    /// Share of the extinction that is scattering, [`SINGLE_SCATTERING_ALBEDO_RANGE`].
    pub single_scattering_albedo: f64,
    /// Mean cosine of the scattering angle: g of Henyey and Greenstein's phase function.
    pub asymmetry: f64,
    /// Altitude over which the density falls to 1/e, km.
    pub scale_height_km: f64,
    /// Ångström exponent: extinction is proportional to λ to the power of minus this.
    pub angstrom: f64,
}

impl Default for Aerosol {
    /// Continental: 0.93, 0.76, 1.2 km, 1.3.
    fn default() -> Self {
        Self {
            single_scattering_albedo: 0.93,
            asymmetry: 0.76,
            scale_height_km: 1.2,
            angstrom: 1.3,
        }
    }
}

/// The air over a place. [`Air::valid`] checks the ranges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air {
    /// Optical depth of the aerosol at 550 nm, from the sea to space, vertically: 0.05 very clear, 0.1 clear, 0.2 hazy, 0.4 murky.
    pub aod: f64,
    /// Amount of ozone, Dobson units.
    pub ozone_du: f64,
    /// Altitude of the observer above the sea, metres.
    pub altitude_m: f64,
    /// Kind of the aerosol.
    pub aerosol: Aerosol,
    /// Diffuse reflectance of the ground (at sea level), the same for all wavelengths.
    pub ground_albedo: f64,
}

impl Default for Air {
    /// Clear air at sea level: AOD 0.1, 300 DU, albedo 0.2.
    fn default() -> Self {
        Self {
            aod: 0.1,
            ozone_du: 300.0,
            altitude_m: 0.0,
            aerosol: Aerosol::default(),
            ground_albedo: 0.2,
        }
    }
}

impl Air {
    /// The air itself if each number is in its range; else one line that names the number and the range.
    pub fn valid(self) -> Result<Self, String> {
        for (name, value, range) in self.numbers() {
            if !range.contains(&value) {
                return Err(format!(
                    "{name} {value} is outside {}..={}",
                    range.start(),
                    range.end()
                ));
            }
        }
        Ok(self)
    }

    /// Each number moved into its range (the default's for NaN), and one line for each that moved.
    pub fn clamped(mut self) -> (Self, Vec<String>) {
        let fallback = Self::default().numbers().map(|(_, value, _)| value);
        let mut warnings = Vec::new();
        let numbers = self.numbers();
        let moved = std::array::from_fn(|i| {
            let (name, asked, range) = &numbers[i];
            let value = if asked.is_nan() {
                fallback[i]
            } else {
                asked.clamp(*range.start(), *range.end())
            };
            if value != *asked {
                let (low, high) = (range.start(), range.end());
                warnings.push(format!(
                    "{name} {asked} is outside {low}..={high}: {value} is used"
                ));
            }
            value
        });
        self.set_numbers(moved);
        (self, warnings)
    }

    fn numbers(&self) -> [(&'static str, f64, RangeInclusive<f64>); 8] {
        let aerosol = &self.aerosol;
        [
            ("aerosol optical depth", self.aod, AOD_RANGE),
            ("ozone (Dobson units)", self.ozone_du, OZONE_RANGE_DU),
            ("altitude (metres)", self.altitude_m, ALTITUDE_RANGE_M),
            ("ground albedo", self.ground_albedo, GROUND_ALBEDO_RANGE),
            (
                "single-scattering albedo of the aerosol",
                aerosol.single_scattering_albedo,
                SINGLE_SCATTERING_ALBEDO_RANGE,
            ),
            (
                "asymmetry of the aerosol",
                aerosol.asymmetry,
                ASYMMETRY_RANGE,
            ),
            (
                "scale height of the aerosol (km)",
                aerosol.scale_height_km,
                SCALE_HEIGHT_RANGE_KM,
            ),
            (
                "Ångström exponent of the aerosol",
                aerosol.angstrom,
                ANGSTROM_RANGE,
            ),
        ]
    }

    fn set_numbers(&mut self, numbers: [f64; 8]) {
        [
            self.aod,
            self.ozone_du,
            self.altitude_m,
            self.ground_albedo,
            self.aerosol.single_scattering_albedo,
            self.aerosol.asymmetry,
            self.aerosol.scale_height_km,
            self.aerosol.angstrom,
        ] = numbers;
    }

    /// Horizontal visibility at sea level, km: 3.912/(AOD/H + 0.0115) (Koschmieder 1924, contrast of 2 %).
    pub fn visibility_km(&self) -> f64 {
        KOSCHMIEDER / (self.aod / self.aerosol.scale_height_km + AIR_EXTINCTION)
    }
}

/// Aerosol optical depth at 550 nm of a visibility in km over an aerosol of `scale_height_km`: [`Air::visibility_km`] the other way
/// round, not below 0.
pub fn aod_of_visibility(visibility_km: f64, scale_height_km: f64) -> f64 {
    ((KOSCHMIEDER / visibility_km - AIR_EXTINCTION) * scale_height_km).max(0.0)
}

/// Aerosol optical depth at 550 nm of Preetham's turbidity T: β(T) 0.55^-1.3, his own aerosol (1999, A.1): 0.1 for T 2, 0.2 for T 3.
pub fn aod_of_turbidity(turbidity: f64) -> f64 {
    (angstrom_beta(turbidity) * 0.55f64.powf(-1.3)).max(0.0)
}

/// Preetham's turbidity T of an aerosol optical depth at 550 nm: [`aod_of_turbidity`] the other way round.
pub fn turbidity_of_aod(aod: f64) -> f64 {
    // β is linear in T.
    let [zero, one] = [0.0, 1.0].map(angstrom_beta);
    (aod / 0.55f64.powf(-1.3) - zero) / (one - zero)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_air_out_of_range_is_named_with_its_range() {
        let told = |air: Air| air.valid().unwrap_err();
        assert_eq!(
            told(Air {
                aod: 3.0,
                ..Air::default()
            }),
            "aerosol optical depth 3 is outside 0..=0.6"
        );
        assert_eq!(
            told(Air {
                altitude_m: 200_000.0,
                ..Air::default()
            }),
            "altitude (metres) 200000 is outside 0..=10000"
        );
        // 0.1 is the share that is absorbed.
        let aerosol = Aerosol {
            single_scattering_albedo: 0.1,
            ..Aerosol::default()
        };
        assert_eq!(
            told(Air {
                aerosol,
                ..Air::default()
            }),
            "single-scattering albedo of the aerosol 0.1 is outside 0.8..=1"
        );
        assert!(
            Air {
                ozone_du: f64::NAN,
                ..Air::default()
            }
            .valid()
            .is_err()
        );
        assert_eq!(Air::default().valid(), Ok(Air::default()));
    }

    #[test]
    fn visibility_and_turbidity_are_other_words_for_the_optical_depth() {
        for (aod, visibility, turbidity) in [(0.1, 41.2, 2.0), (0.2, 21.9, 3.0), (0.4, 11.3, 5.0)] {
            let air = Air {
                aod,
                ..Air::default()
            };
            assert!(
                (air.visibility_km() - visibility).abs() < 0.2,
                "{}",
                air.visibility_km()
            );
            assert!((aod_of_visibility(air.visibility_km(), 1.2) - aod).abs() < 1e-12);
            assert!((aod_of_turbidity(turbidity) - aod).abs() < 0.01);
            assert!((turbidity_of_aod(aod_of_turbidity(turbidity)) - turbidity).abs() < 1e-12);
        }
        assert_eq!(aod_of_visibility(1e6, 1.2), 0.0);
    }
}
