//! The stars brighter than magnitude 5 as points of light, where a place has them at a moment.
//!
//! XHIP's positions of J2000 are turned by precession, nutation and the earth; proper motion (less than 0.03° by 2026) and aberration (20″) are left out.
//! [`super::sky::NIGHT_LUMINANCE`] stands for the stars that are too faint to be seen one by one, and for the airglow.

use std::sync::LazyLock;

use chrono::{DateTime, FixedOffset};
use glam::{DMat3, DVec3, DVec4};

use super::atmosphere::columns::horizon_cosine;
use super::atmosphere::{self, Atmosphere};
use super::celestial::{Instant, world_from_earth};
use super::colour::{clip_negative, rgb_from_xyz};
use super::moon::MAGNITUDE_ZERO_LUX;
use super::spectrum::xyz_of_black_body;
use super::sun_position::{SunPositionError, azimuth_elevation, direction, refraction_deg};

/// Illuminance by the sky above which no star is drawn, lux. In a picture whose pixels are 5′ wide Sirius is then a thousandth of its pixel.
pub const MOST_SKY_LUX: f64 = 1e4;

/// A star outside the air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Star {
    /// Unit vector in the celestial frame of J2000.
    pub direction: DVec3,
    /// Visual magnitude.
    pub magnitude: f64,
    /// Illuminance at normal incidence, linear BT.709 RGB, lux.
    pub illuminance: DVec3,
}

/// A star as seen from the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// Unit vector toward it in world space.
    pub direction: DVec3,
    /// Illuminance at normal incidence, linear BT.709 RGB, lux.
    pub illuminance: DVec3,
}

/// The stars, the brightest first.
pub fn catalogue() -> &'static [Star] {
    static STARS: LazyLock<Vec<Star>> = LazyLock::new(|| {
        let colours = Colours::new();
        let lines = include_str!("data/stars.csv").lines();
        lines.filter_map(|line| star(line, &colours)).collect()
    });
    &STARS
}

/// The star of a line; `None` for comments.
fn star(line: &str, colours: &Colours) -> Option<Star> {
    let mut numbers = line.split(',').map(|text| text.parse::<f64>().ok());
    let mut next = || numbers.next().flatten();
    let (right_ascension, declination) = (next()?.to_radians(), next()?.to_radians());
    let (magnitude, colour_index) = (next()?, next()?);
    let lux = MAGNITUDE_ZERO_LUX * 10f64.powf(-0.4 * magnitude);
    let (across, z) = (declination.cos(), declination.sin());
    Some(Star {
        direction: DVec3::new(
            across * right_ascension.cos(),
            across * right_ascension.sin(),
            z,
        ),
        magnitude,
        illuminance: colours.of(colour_index) * lux,
    })
}

/// Colours of a luminance of 1 by the colour index B-V.
struct Colours(Vec<DVec3>);

impl Colours {
    const LEAST: f64 = -0.4;
    const STEP: f64 = 0.1;

    fn new() -> Self {
        let of = |i: u32| {
            let xyz = xyz_of_black_body(kelvin(Self::LEAST + Self::STEP * f64::from(i)));
            clip_negative(rgb_from_xyz(xyz / xyz.y))
        };
        Self((0..=40).map(of).collect())
    }

    fn of(&self, colour_index: f64) -> DVec3 {
        let last = (self.0.len() - 2) as f64;
        let at = ((colour_index - Self::LEAST) / Self::STEP).clamp(0.0, last);
        // Not negative: the cast truncates.
        let i = at as usize;
        self.0[i].lerp(self.0[i + 1], at - i as f64)
    }
}

/// Ballesteros 2012, *New insights into black bodies*: temperature of a star by its colour index B-V, K.
fn kelvin(colour_index: f64) -> f64 {
    4600.0 * (1.0 / (0.92 * colour_index + 1.7) + 1.0 / (0.92 * colour_index + 0.62))
}

/// The stars of a place at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StarrySky {
    /// From the celestial frame of J2000 to world space.
    pub world_from_celestial: DMat3,
    /// Whether the air lifts them to their apparent elevation.
    pub is_refracted: bool,
    /// Share of their light that clouds leave, 0..=1.
    pub clear: f64,
}

impl StarrySky {
    /// The stars at `when` over `latitude` (±90°) and `longitude` (±180°), without clouds.
    ///
    /// # Errors
    /// Coordinates out of range, or a year outside of [`super::sun_position::YEARS`].
    pub fn at(
        when: DateTime<FixedOffset>,
        latitude: f64,
        longitude: f64,
    ) -> Result<Self, SunPositionError> {
        let world_from_earth = world_from_earth(latitude, longitude)?;
        Ok(Self {
            world_from_celestial: world_from_earth * Instant::of(when)?.earth_from_celestial(),
            is_refracted: true,
            clear: 1.0,
        })
    }

    /// Unit vector toward a star in world space.
    pub fn toward(&self, star: &Star) -> DVec3 {
        let toward = self.world_from_celestial * star.direction;
        if !self.is_refracted {
            return toward;
        }
        let (azimuth_deg, elevation_deg) = azimuth_elevation(toward);
        direction(azimuth_deg, elevation_deg + refraction_deg(elevation_deg))
    }

    /// The stars above the horizon of an observer in `atmosphere`, through its air.
    pub fn seen(&self, atmosphere: &Atmosphere) -> Vec<PointLight> {
        let horizon = horizon_cosine(atmosphere.observer());
        let white = rgb_from_xyz(atmosphere::colour::xyz(DVec4::ONE));
        let of = |star: &Star| {
            let direction = self.toward(star);
            let through = atmosphere.to_space(direction.y);
            let through = clip_negative(rgb_from_xyz(atmosphere::colour::xyz(through)) / white);
            (direction.y > horizon).then(|| PointLight {
                direction,
                illuminance: star.illuminance * through * self.clear,
            })
        };
        catalogue().iter().filter_map(of).collect()
    }
}

#[cfg(test)]
#[path = "stars_tests.rs"]
mod tests;
