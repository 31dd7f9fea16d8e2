//! Figures of a daylight: as JSON with fixed field names, and as a table by [`Display`](std::fmt::Display).

use std::collections::BTreeMap;

use glam::DVec3;
use serde::Serialize;

use super::light::Light;
use super::sky_almanac::{Almanac, rfc3339};
use crate::daylight::colour::{
    chromaticity, correlated_colour_temperature, luminance, xyz_from_rgb,
};
use crate::daylight::irradiance::IrradianceEstimator;
use crate::daylight::perez::AllWeather;
use crate::daylight::sky::SkyModel;
use crate::daylight::sun_position::{self, Polar, SunEvents, sun_events};
use crate::daylight::sunlight::{Sunlight, air_mass};
use crate::error::Result;
use crate::options::Direction;

/// The axes: key, label and direction.
pub const AXES: [(&str, &str, DVec3); 6] = [
    ("+x", "east", DVec3::X),
    ("-x", "west", DVec3::NEG_X),
    ("+y", "up", DVec3::Y),
    ("-y", "down", DVec3::NEG_Y),
    ("+z", "south", DVec3::Z),
    ("-z", "north", DVec3::NEG_Z),
];

/// Highest correlated colour temperature reported, K.
const HOTTEST: f64 = 9e5;

/// The report of `skylight sky`. RGB is linear BT.709, in cd/m² for luminances and lux for illuminances.
#[derive(Debug, Serialize)]
pub struct SkyReport {
    /// The options that reproduce this daylight.
    pub inputs: BTreeMap<String, String>,
    pub sun: SunReport,
    /// The times of the date and the moon; absent without a place and a moment.
    #[serde(flatten)]
    pub almanac: Option<Almanac>,
    pub sky: SkyPart,
    /// Radiance of all directions below the horizon.
    pub ground: GroundPart,
    /// Illuminance of a horizontal plane by sky and sun, or moon while the sun gives no light, lux.
    pub global_horizontal_lux: f64,
    pub warnings: Vec<String>,
}

#[derive(Debug, Serialize)]
pub struct SunReport {
    pub azimuth_deg: f64,
    /// True elevation, without refraction, degrees.
    pub elevation_deg: f64,
    /// Apparent elevation, degrees; used for everything else.
    pub apparent_elevation_deg: f64,
    pub direction: [f64; 3],
    /// Relative air mass at the apparent elevation; below the horizon, its value at the horizon.
    pub air_mass: f64,
    /// Illuminance at normal incidence, lux.
    pub illuminance_lux: f64,
    pub illuminance_rgb: [f64; 3],
    /// Luminance of the disc, cd/m².
    pub luminance: f64,
    pub luminance_rgb: [f64; 3],
    /// Direct illuminance of a horizontal plane, lux.
    pub direct_horizontal_lux: f64,
    /// Correlated colour temperature, K; `None` when the sun has set.
    pub cct_k: Option<f64>,
    /// Sunrise, RFC 3339 in the UTC offset of --when. `None` in polar day or night, and without a place and a moment.
    pub sunrise: Option<String>,
    pub solar_noon: Option<String>,
    pub sunset: Option<String>,
    /// "day" or "night" if the sun neither rises nor sets on this date.
    pub polar: Option<&'static str>,
}

#[derive(Debug, Serialize)]
pub struct SkyPart {
    pub model: String,
    /// Turbidity used, clamped to the model's range.
    pub turbidity: f64,
    pub ground_albedo: f64,
    /// Only of the measured sky.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured: Option<MeasuredPart>,
    pub zenith_luminance: f64,
    pub zenith_rgb: [f64; 3],
    pub zenith_chromaticity: [f64; 2],
    /// Correlated colour temperature of the zenith, K; `None` if it is bluer than any black body.
    pub zenith_cct_k: Option<f64>,
    /// Correlated colour temperature of the light on a horizontal plane, K.
    pub cct_k: Option<f64>,
    pub diffuse_horizontal_lux: f64,
    pub diffuse_horizontal_rgb: [f64; 3],
    /// Illuminance (RGB, lux) by sky and ground, without the sun, of planes facing the axes.
    pub irradiance: BTreeMap<&'static str, [f64; 3]>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub samples: Vec<Sample>,
}

/// What Perez' model makes of the irradiances.
#[derive(Debug, Serialize)]
pub struct MeasuredPart {
    /// ε, 1 to 12.
    pub clearness: f64,
    /// Δ, 0.01 to 0.6.
    pub brightness: f64,
    /// Precipitable water, cm.
    pub water_cm: f64,
    /// Luminous efficacies of the light of sky and sun, lm/W.
    pub diffuse_efficacy: f64,
    pub direct_efficacy: f64,
}

#[derive(Debug, Serialize)]
pub struct GroundPart {
    pub luminance: f64,
    pub rgb: [f64; 3],
}

/// Radiance in one direction: sky above the horizon, ground below. Excludes the sun's disc.
#[derive(Debug, Serialize)]
pub struct Sample {
    pub azimuth_deg: f64,
    pub elevation_deg: f64,
    pub rgb: [f64; 3],
    pub luminance: f64,
}

impl SkyReport {
    /// Computes the figures of `light`, and its radiance in `directions`.
    ///
    /// # Errors
    /// A date that the ephemeris does not cover.
    pub fn new(light: &Light, directions: &[Direction]) -> Result<Self> {
        let daylight = &light.daylight;
        let sun = SunReport::new(light)?;
        let sky = SkyPart::new(light, directions);
        Ok(Self {
            inputs: light.settings.light().into_iter().collect(),
            ground: GroundPart {
                luminance: luminance(daylight.ground_luminance),
                rgb: daylight.ground_luminance.to_array(),
            },
            almanac: Almanac::new(light)?,
            global_horizontal_lux: luminance(daylight.horizontal()),
            sun,
            sky,
            warnings: daylight.warnings.clone(),
        })
    }
}

impl SunReport {
    fn new(light: &Light) -> Result<Self> {
        let daylight = &light.daylight;
        let events = events(light)?;
        let illuminance = luminance(daylight.sun_illuminance);
        let apparent = light.sun.apparent_elevation_deg;
        Ok(Self {
            azimuth_deg: light.sun.azimuth_deg,
            elevation_deg: light.sun.elevation_deg,
            apparent_elevation_deg: apparent,
            direction: daylight.sun_direction.to_array(),
            air_mass: air_mass(apparent),
            illuminance_lux: illuminance,
            illuminance_rgb: daylight.sun_illuminance.to_array(),
            luminance: luminance(daylight.sun_luminance),
            luminance_rgb: daylight.sun_luminance.to_array(),
            direct_horizontal_lux: illuminance * daylight.sun_direction.y.max(0.0),
            cct_k: (illuminance > 0.0)
                .then(|| sun_temperature(light))
                .flatten(),
            sunrise: rfc3339(events.and_then(|e| e.sunrise)),
            solar_noon: rfc3339(events.and_then(|e| e.noon)),
            sunset: rfc3339(events.and_then(|e| e.sunset)),
            polar: events.and_then(|e| polar(light, &e)),
        })
    }
}

/// Correlated colour temperature of the sun, from its spectrum before gamut mapping to BT.709.
fn sun_temperature(light: &Light) -> Option<f64> {
    let elevation = light.conditions.sun_elevation_deg.max(0.0);
    let xyz = Sunlight::new(light.turbidity(), elevation).luminance_xyz;
    temperature(xyz)
}

/// Correlated colour temperature, K; `None` if it is bluer than any black body.
pub(super) fn temperature(xyz: DVec3) -> Option<f64> {
    correlated_colour_temperature(xyz).filter(|kelvin| *kelvin < HOTTEST)
}

fn events(light: &Light) -> Result<Option<SunEvents>> {
    let Some((latitude, longitude, when)) = light.settings.sun.place() else {
        return Ok(None);
    };
    let day = when.date_naive();
    Ok(Some(sun_events(day, *when.offset(), latitude, longitude)?))
}

fn polar(light: &Light, events: &SunEvents) -> Option<&'static str> {
    let (latitude, longitude, _) = light.settings.sun.place()?;
    Some(match events.polar(latitude, longitude)? {
        Polar::Day => "day",
        Polar::Night => "night",
    })
}

impl SkyPart {
    fn new(light: &Light, directions: &[Direction]) -> Self {
        let (daylight, settings) = (&light.daylight, &light.settings);
        let zenith = daylight.radiance(DVec3::Y);
        let up = daylight.sky_irradiance_up;
        let radiance = |direction| daylight.radiance(direction);
        let e =
            IrradianceEstimator::new(settings.irradiance, radiance, settings.irradiance_samples);
        Self {
            model: settings.sky.to_string(),
            turbidity: light.turbidity(),
            ground_albedo: settings.ground_albedo,
            measured: measured(light),
            zenith_luminance: luminance(zenith),
            zenith_rgb: zenith.to_array(),
            zenith_chromaticity: chromaticity(xyz_from_rgb(zenith)),
            zenith_cct_k: temperature(xyz_from_rgb(zenith)),
            cct_k: temperature(xyz_from_rgb(up)),
            diffuse_horizontal_lux: luminance(up),
            diffuse_horizontal_rgb: up.to_array(),
            irradiance: AXES.map(|(name, _, n)| (name, e.at(n).to_array())).into(),
            samples: directions.iter().map(|d| sample(light, *d)).collect(),
        }
    }
}

fn measured(light: &Light) -> Option<MeasuredPart> {
    let conditions = &light.conditions;
    (conditions.model == SkyModel::Perez).then(|| {
        let weather = AllWeather::new(&conditions.measured, conditions.sun_elevation_deg);
        MeasuredPart {
            clearness: weather.clearness,
            brightness: weather.brightness,
            water_cm: conditions.measured.precipitable_water_cm(),
            diffuse_efficacy: weather.diffuse_efficacy,
            direct_efficacy: weather.direct_efficacy,
        }
    })
}

fn sample(light: &Light, at: Direction) -> Sample {
    let direction = sun_position::direction(at.azimuth_deg, at.elevation_deg);
    let rgb = light.daylight.radiance(direction);
    Sample {
        azimuth_deg: at.azimuth_deg,
        elevation_deg: at.elevation_deg,
        rgb: rgb.to_array(),
        luminance: luminance(rgb),
    }
}
