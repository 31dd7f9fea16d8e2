//! The sky of measured irradiances: Perez, Seals & Michalsky 1993, *All-weather model for sky luminance distribution*.
//!
//! The irradiances by sun and sky give the clearness ε and the brightness Δ; these give the form of the sky (five coefficients of
//! [`super::grey_sky`]) and, with the luminous efficacies of Perez et al. 1990, the illuminances by sky and sun in lux.

use super::data::perez_1993::{CLEARNESS, COEFFICIENTS, DIFFUSE_EFFICACY, DIRECT_EFFICACY};
use super::grey_sky::Distribution;
use super::sun_position::distance_factor;
use super::sunlight::{WATER_VAPOUR_CM, air_mass};

/// Irradiance outside the air at the mean distance of the sun, W/m² (Perez et al. 1990).
pub const SOLAR_CONSTANT_W: f64 = 1367.0;

/// Largest irradiance that [`Measured`] may hold, W/m²: above the sun's outside the air at its least distance, 1414.
pub const MOST_IRRADIANCE_W: f64 = 1500.0;

/// Dew points that [`Measured`] may hold, °C: those of the earth's surface.
pub const DEW_POINTS: (f64, f64) = (-90.0, 40.0);

/// Measured irradiances over all wavelengths.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// By the sun at normal incidence, W/m², 0..=[`MOST_IRRADIANCE_W`].
    pub direct_normal_w: f64,
    /// By the sky on a horizontal plane, W/m², 0..=[`MOST_IRRADIANCE_W`]; at 0 it is night, without light from sky and sun.
    pub diffuse_horizontal_w: f64,
    /// Dew point at the ground, °C, within [`DEW_POINTS`]. `None` is [`WATER_VAPOUR_CM`] of precipitable water, the dew point 11 °C.
    pub dew_point_c: Option<f64>,
    /// Day of the year, 1..=366, for the distance of the sun. `None` is its mean distance.
    pub day_of_year: Option<u32>,
}

impl Measured {
    /// Wright, Perez & Michalsky 1989 (in Perez et al. 1990): precipitable water, cm: exp(0.07 T_d - 0.075), T_d in °C.
    pub fn precipitable_water_cm(&self) -> f64 {
        self.dew_point_c
            .map_or(WATER_VAPOUR_CM, |dew| (0.07 * dew - 0.075).exp())
    }
}

/// What the model makes of a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AllWeather {
    /// Clearness ε: 1 overcast, from 6.2 on clear; in 1..=12.009.
    pub clearness: f64,
    /// Brightness Δ of the sky, in 0.01..=0.6.
    pub brightness: f64,
    /// Relative luminances.
    pub distribution: Distribution,
    /// Luminous efficacy of the light of the sky, lm/W.
    pub diffuse_efficacy: f64,
    /// Luminous efficacy of the light of the sun, lm/W.
    pub direct_efficacy: f64,
    /// Illuminance of a horizontal plane by the sky, lux.
    pub diffuse_horizontal_lux: f64,
    /// Illuminance by the sun at normal incidence, lux.
    pub direct_normal_lux: f64,
}

impl AllWeather {
    /// The sky of a measurement with the sun at `elevation_deg`, clamped to 0..=87: the model has no sun nearer to the zenith.
    pub fn new(measured: &Measured, elevation_deg: f64) -> Self {
        let elevation = elevation_deg.clamp(0.0, 87.0);
        let zenith = (90.0 - elevation).to_radians();
        let (direct, diffuse) = (measured.direct_normal_w, measured.diffuse_horizontal_w);
        let is_dark = diffuse <= 0.0;
        let cubed = 1.041 * zenith.powi(3);
        let ratio = if is_dark {
            1.0
        } else {
            (diffuse + direct) / diffuse
        };
        let clearness = ((ratio + cubed) / (1.0 + cubed)).clamp(1.0, 12.009);
        let outside = SOLAR_CONSTANT_W * measured.day_of_year.map_or(1.0, distance_factor);
        let brightness = (diffuse * air_mass(elevation) / outside).clamp(0.01, 0.6);
        let bin = CLEARNESS
            .iter()
            .filter(|limit| clearness >= **limit)
            .count();
        let water = measured.precipitable_water_cm();
        let [a, b, c, d] = DIFFUSE_EFFICACY[bin];
        let diffuse_efficacy = a + b * water + c * zenith.cos() + d * brightness.ln();
        let [a, b, c, d] = DIRECT_EFFICACY[bin];
        let direct_efficacy = a + b * water + c * (5.73 * zenith - 5.0).exp() + d * brightness;
        let (diffuse_efficacy, direct_efficacy) =
            (diffuse_efficacy.max(0.0), direct_efficacy.max(0.0));
        Self {
            clearness,
            brightness,
            distribution: distribution(bin, clearness, brightness, zenith),
            diffuse_efficacy,
            direct_efficacy,
            diffuse_horizontal_lux: diffuse_efficacy * diffuse,
            direct_normal_lux: if is_dark {
                0.0
            } else {
                direct_efficacy * direct
            },
        }
    }
}

/// Perez et al. 1993: a..e of a bin of clearness (0..=7), `zenith` in radians.
fn distribution(bin: usize, clearness: f64, brightness: f64, zenith: f64) -> Distribution {
    // The paper keeps Δ from below 0.2 between overcast and intermediate skies.
    let is_between = clearness > 1.065 && clearness < 2.8;
    let delta = if is_between {
        brightness.max(0.2)
    } else {
        brightness
    };
    let table = &COEFFICIENTS[bin];
    let [a, b, mut c, mut d, e] =
        table.map(|[x1, x2, x3, x4]| x1 + x2 * zenith + delta * (x3 + x4 * zenith));
    if bin == 0 {
        let [c1, c2, c3, c4] = table[2];
        let [d1, d2, d3, d4] = table[3];
        c = (delta * (c1 + c2 * zenith)).powf(c3).exp() - c4;
        d = -(delta * (d1 + d2 * zenith)).exp() + d3 + delta * d4;
    }
    Distribution {
        gradation: [a, b, 0.0],
        indicatrix: [1.0, c, d, e],
        // b is positive for some skies: exp(b / cos Z) would have no limit. The programs of Radiance stop here, too.
        least_cosine: 0.01,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::grey_sky::GreySky;
    use crate::daylight::quadrature::horizontal_irradiance;
    use crate::daylight::sun_position::direction;

    fn sky(direct: f64, diffuse: f64, elevation: f64) -> AllWeather {
        let measured = Measured {
            direct_normal_w: direct,
            diffuse_horizontal_w: diffuse,
            ..Measured::default()
        };
        AllWeather::new(&measured, elevation)
    }

    #[test]
    fn no_direct_light_is_overcast_and_much_is_clear() {
        let (overcast, clear) = (sky(0.0, 150.0, 30.0), sky(900.0, 80.0, 60.0));
        assert_eq!(overcast.clearness, 1.0);
        assert!(clear.clearness > 6.2, "{clear:?}");
        // Typical efficacies: 110 to 120 lm/W of clouds, more of blue sky, around 100 of the sun.
        assert!((105.0..125.0).contains(&overcast.diffuse_efficacy));
        assert!((120.0..150.0).contains(&clear.diffuse_efficacy));
        assert!((95.0..110.0).contains(&clear.direct_efficacy));
    }

    #[test]
    fn the_default_water_is_that_of_11_degrees() {
        let at = |dew_point_c| Measured {
            dew_point_c,
            ..Measured::default()
        };
        let water = at(Some(11.0)).precipitable_water_cm();
        assert!((water / at(None).precipitable_water_cm() - 1.0).abs() < 2e-3);
    }

    #[test]
    fn every_measurement_gives_a_finite_sky() {
        for direct in [0.0, 1.0, 30.0, 200.0, 700.0, 1500.0] {
            for diffuse in [0.0, 0.5, 5.0, 40.0, 150.0, 500.0, 1500.0] {
                for elevation in [-20.0, 0.0, 0.5, 4.0, 20.0, 50.0, 80.0, 90.0] {
                    let found = sky(direct, diffuse, elevation);
                    let sun = direction(0.0, f64::max(elevation, 0.0));
                    let lux = found.diffuse_horizontal_lux;
                    let seen = GreySky::new(found.distribution, sun, lux);
                    let up = horizontal_irradiance(|dir| seen.radiance(dir)).x;
                    assert!(
                        up.is_finite() && (up > 0.0) == (lux > 0.0),
                        "{direct} {diffuse} {elevation} {up} {lux}"
                    );
                    assert!(found.direct_normal_lux.is_finite());
                    assert!(diffuse > 0.0 || found.direct_normal_lux == 0.0);
                }
            }
        }
    }
}
