//! The moon: where it stands, how much of it is lit, and its light.
//!
//! Positions are topocentric: the moon's parallax is up to 1°. They are SOFA's `moon98` (Meeus 1998, ch. 47: 10″), turned to
//! the earth by the precession and nutation of IAU 2000B, seen from the WGS84 ellipsoid at sea level. Time is that of
//! [`super::sun_position::spa`].

use std::f64::consts::PI;

use chrono::{DateTime, Duration, FixedOffset, NaiveDate};
use glam::DVec3;

use super::celestial::{Instant, UNIX_EPOCH_JD, world_from_earth};
use super::colour;
use super::preetham::angle_between;
use super::sun_path::at_hour;
use super::sun_position::{
    SunPositionError, azimuth_elevation, direction, distance_factor, refraction_deg, spa,
};
use super::sunlight::{Sunlight, visible_fraction};

/// Mean distance of the moon, km, to which [`magnitude`] refers.
pub const MEAN_DISTANCE_KM: f64 = 384_400.0;

/// Radius of the moon, km (IAU).
pub const RADIUS_KM: f64 = 1737.4;

/// Illuminance of a star of magnitude 0 outside the air, lux (Allen 1973).
pub const MAGNITUDE_ZERO_LUX: f64 = 2.54e-6;

const ASTRONOMICAL_UNIT_KM: f64 = 149_597_870.7;

/// Time step when searching for rise and set, minutes.
const STEP_MINUTES: i64 = 20;

/// The moon as seen from a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moon {
    /// Azimuth, degrees in 0..360, clockwise from north.
    pub azimuth_deg: f64,
    /// True (geometric) elevation of the centre, degrees in -90..=90.
    pub elevation_deg: f64,
    /// Apparent elevation, degrees: the true one plus [`refraction_deg`].
    pub apparent_elevation_deg: f64,
    /// Distance from the place, km.
    pub distance_km: f64,
    /// Angle between sun and observer as seen from the moon, degrees: 0 full, 180 new.
    pub phase_angle_deg: f64,
    /// Unit vector from the moon toward the sun, in world space.
    pub sunward: DVec3,
}

impl Moon {
    /// The moon at `when`, seen from `latitude` (±90°) and `longitude` (±180°).
    ///
    /// # Errors
    /// Coordinates out of range, or a year outside of [`super::sun_position::YEARS`].
    pub fn at(
        when: DateTime<FixedOffset>,
        latitude: f64,
        longitude: f64,
    ) -> Result<Self, SunPositionError> {
        let seen = topocentric_km(when, latitude, longitude)?;
        let (distance_km, toward) = (seen.length(), seen.normalize());
        let sun = spa(when, latitude, longitude)?;
        let sun_direction = direction(sun.azimuth_deg, sun.elevation_deg);
        let day = chrono::Datelike::ordinal(&when);
        let sun_km = ASTRONOMICAL_UNIT_KM / distance_factor(day).sqrt();
        let sunward = sun_direction * sun_km - seen;
        let (azimuth_deg, elevation_deg) = azimuth_elevation(toward);
        Ok(Self {
            azimuth_deg,
            elevation_deg,
            apparent_elevation_deg: elevation_deg + refraction_deg(elevation_deg),
            distance_km,
            phase_angle_deg: angle_between(sunward.normalize(), -toward).to_degrees(),
            sunward: sunward.normalize(),
        })
    }

    /// Unit vector toward the apparent moon, in world space.
    pub fn direction(&self) -> DVec3 {
        direction(self.azimuth_deg, self.apparent_elevation_deg)
    }

    /// Unit vector toward the true (not refracted) moon, in world space.
    pub fn true_direction(&self) -> DVec3 {
        direction(self.azimuth_deg, self.elevation_deg)
    }

    /// Share of the disc that is lit, 0..=1.
    pub fn illuminated_fraction(&self) -> f64 {
        (1.0 + self.phase_angle_deg.to_radians().cos()) / 2.0
    }

    /// Diameter of the disc, degrees, some 0.49..=0.57.
    pub fn angular_diameter_deg(&self) -> f64 {
        2.0 * (RADIUS_KM / self.distance_km).asin().to_degrees()
    }

    /// Visual magnitude outside the air: [`magnitude`], scaled by the distance.
    pub fn magnitude(&self) -> f64 {
        magnitude(self.phase_angle_deg) + 5.0 * (self.distance_km / MEAN_DISTANCE_KM).log10()
    }

    /// Illuminance at normal incidence outside the air, lux; some 0.3 when full.
    pub fn outside_lux(&self) -> f64 {
        MAGNITUDE_ZERO_LUX * 10f64.powf(-0.4 * self.magnitude())
    }

    /// The light of the moon on the ground, through air of `turbidity` (1..=10).
    pub fn light(&self, turbidity: f64) -> Moonlight {
        let elevation = self.apparent_elevation_deg;
        let outside = Sunlight::extraterrestrial().luminance_xyz.y;
        self.light_through(Sunlight::new(turbidity, elevation.max(0.0)).luminance() / outside)
    }

    /// The light of the moon on the ground, through air with this transmittance of sunlight: linear BT.709 RGB over the luminance outside.
    pub fn light_through(&self, through: DVec3) -> Moonlight {
        let elevation = self.apparent_elevation_deg;
        let whole = colour::clip_negative(through) * self.outside_lux();
        let angular_radius = self.angular_diameter_deg().to_radians() / 2.0;
        let solid_angle = PI * angular_radius.sin().powi(2);
        Moonlight {
            direction: self.direction(),
            illuminance: whole * visible_fraction(elevation),
            luminance: whole / (solid_angle * phase_function(self.phase_angle_deg)),
            sunward: self.sunward,
            angular_radius,
        }
    }

    /// Whether the upper limb is above the apparent horizon.
    fn is_up(&self) -> bool {
        self.apparent_elevation_deg + self.angular_diameter_deg() / 2.0 > 0.0
    }
}

/// The moon's light on the ground.
///
/// It has the sun's spectrum: that the moon is a little redder is left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moonlight {
    /// Unit vector toward the apparent centre.
    pub direction: DVec3,
    /// Illuminance at normal incidence, linear BT.709 RGB, lux; 0 once the disc has set.
    pub illuminance: DVec3,
    /// Luminance of the disc where sunlight and line of sight are equally inclined to the surface, as everywhere on the full
    /// moon: linear BT.709 RGB, cd/m².
    pub luminance: DVec3,
    /// Unit vector from the moon toward the sun.
    pub sunward: DVec3,
    /// Angular radius of the disc, radians.
    pub angular_radius: f64,
}

impl Moonlight {
    /// This light times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            illuminance: self.illuminance * factor,
            luminance: self.luminance * factor,
            ..*self
        }
    }

    /// Luminance of the disc in the unit direction `dir`, linear BT.709 RGB, cd/m²; 0 beside it and on its dark side.
    ///
    /// Lommel and Seeliger's law on a sphere, 2 μ₀ / (μ₀ + μ): μ₀ and μ are the cosines of sun and observer. The full moon is
    /// as bright at its limb as in its middle, as the true one nearly is.
    pub fn disc(&self, dir: DVec3) -> DVec3 {
        let across = self.direction.cross(dir).cross(self.direction) / self.angular_radius.sin();
        let beside = across.length_squared();
        if beside >= 1.0 || dir.dot(self.direction) <= 0.0 {
            return DVec3::ZERO;
        }
        let to_eye = (1.0 - beside).sqrt();
        let to_sun = (across - self.direction * to_eye)
            .dot(self.sunward)
            .max(0.0);
        self.luminance * (2.0 * to_sun / (to_sun + to_eye).max(1e-9))
    }
}

/// Light of a sphere of Lommel and Seeliger's law by the phase angle, relative to that of the full one: 1 - sin(α/2) tan(α/2)
/// ln cot(α/4). Beyond 175°, where the moon is lost beside the sun, its value there.
fn phase_function(phase_angle_deg: f64) -> f64 {
    let half = phase_angle_deg.clamp(1e-6, 175.0).to_radians() / 2.0;
    1.0 + half.sin() * half.tan() * (half / 2.0).tan().ln()
}

/// Allen 1973 (as Krisciunas & Schaefer 1991 write it): visual magnitude of the moon at its mean distance, for the phase angle in
/// degrees: -12.73 + 0.026 |α| + 4e-9 α⁴. Its authors state 8 to 23 % for the light; the surge within 7° of full is not in it.
pub fn magnitude(phase_angle_deg: f64) -> f64 {
    -12.73 + 0.026 * phase_angle_deg.abs() + 4e-9 * phase_angle_deg.powi(4)
}

/// The moments of one calendar day at which the upper limb appears and vanishes; a day may have neither.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MoonEvents {
    /// First moonrise.
    pub rise: Option<DateTime<FixedOffset>>,
    /// First moonset.
    pub set: Option<DateTime<FixedOffset>>,
}

/// Moonrise and moonset on the calendar day of `date` at the UTC offset `offset`, to the second.
///
/// # Errors
/// As [`Moon::at`].
pub fn moon_events(
    date: NaiveDate,
    offset: FixedOffset,
    latitude: f64,
    longitude: f64,
) -> Result<MoonEvents, SunPositionError> {
    let midnight = at_hour(date, offset, 0)?;
    let is_up = |when| Ok(Moon::at(when, latitude, longitude)?.is_up());
    let mut events = MoonEvents::default();
    let (mut before, mut was_up) = (midnight, is_up(midnight)?);
    for step in 1..=24 * 60 / STEP_MINUTES {
        let now = midnight + Duration::minutes(step * STEP_MINUTES);
        // The last day of all ends within the years: the next midnight is beyond them.
        let Ok(up) = is_up(now) else { break };
        let event = if up {
            &mut events.rise
        } else {
            &mut events.set
        };
        if up != was_up && event.is_none() {
            *event = Some(change(before, now, was_up, is_up)?);
        }
        (before, was_up) = (now, up);
    }
    Ok(events)
}

/// The moment between two at which a condition that was `early` changes, by bisection to a second.
fn change(
    mut early: DateTime<FixedOffset>,
    mut late: DateTime<FixedOffset>,
    value: bool,
    of: impl Fn(DateTime<FixedOffset>) -> Result<bool, SunPositionError>,
) -> Result<DateTime<FixedOffset>, SunPositionError> {
    while late - early > Duration::seconds(1) {
        let middle = early + (late - early) / 2;
        if of(middle)? == value {
            early = middle;
        } else {
            late = middle;
        }
    }
    Ok(late)
}

/// From the place to the moon's centre in world space, km.
fn topocentric_km(
    when: DateTime<FixedOffset>,
    latitude: f64,
    longitude: f64,
) -> Result<DVec3, SunPositionError> {
    let world_from_earth = world_from_earth(latitude, longitude)?;
    let instant = Instant::of(when)?;
    let [position, _] = sofars::eph::moon98(UNIX_EPOCH_JD, instant.terrestrial);
    let position = DVec3::from_array(position) * ASTRONOMICAL_UNIT_KM;
    let moon = instant.earth_from_celestial() * position;
    let ((sin_lat, cos_lat), (sin_lon, cos_lon)) = (
        latitude.to_radians().sin_cos(),
        longitude.to_radians().sin_cos(),
    );
    // WGS84.
    let (radius_km, flattening) = (6378.137, 1.0 / 298.257_223_563);
    let shrink = (1.0 - flattening) * (1.0 - flattening);
    let across = radius_km / (cos_lat * cos_lat + shrink * sin_lat * sin_lat).sqrt();
    let place = across * DVec3::new(cos_lat * cos_lon, cos_lat * sin_lon, shrink * sin_lat);
    Ok(world_from_earth * (moon - place))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::sun_position::sun_events;

    #[test]
    fn published_phases_have_their_illuminances() {
        // Krisciunas & Schaefer's relation with 2.54e-6 lux: full, 30°, 60°, 90°, 135°.
        for (phase, lux) in [
            (0.0, 0.314),
            (30.0, 0.153),
            (60.0, 0.071),
            (90.0, 0.029),
            (135.0, 0.0036),
        ] {
            let found = MAGNITUDE_ZERO_LUX * 10f64.powf(-0.4 * magnitude(phase));
            assert!((found / lux - 1.0).abs() < 0.02, "{phase} {found}");
        }
    }

    #[test]
    fn a_nearer_moon_is_brighter_and_larger() {
        let moon = |distance_km| Moon {
            azimuth_deg: 0.0,
            elevation_deg: 40.0,
            apparent_elevation_deg: 40.0,
            distance_km,
            phase_angle_deg: 0.0,
            sunward: DVec3::Y,
        };
        let (near, far) = (moon(356_500.0), moon(406_700.0));
        let ratio = near.outside_lux() / far.outside_lux();
        assert!((ratio / (406.7f64 / 356.5).powi(2) - 1.0).abs() < 1e-12);
        assert!((near.angular_diameter_deg() - 0.5585).abs() < 1e-3);
        let ground = colour::luminance(near.light(3.0).illuminance) / near.outside_lux();
        assert!((0.5..0.8).contains(&ground), "{ground}");
    }

    #[test]
    fn the_full_moon_rises_when_the_sun_sets() {
        // Copenhagen on the day of a full moon.
        let date = NaiveDate::from_ymd_opt(2026, 1, 3).unwrap();
        let offset = FixedOffset::east_opt(3600).unwrap();
        let events = moon_events(date, offset, 55.6761, 12.5683).unwrap();
        let sun = sun_events(date, offset, 55.6761, 12.5683).unwrap();
        for (moonlit, sunlit) in [(events.rise, sun.sunset), (events.set, sun.sunrise)] {
            let apart = moonlit.unwrap() - sunlit.unwrap();
            assert!(apart.num_minutes().abs() < 60, "{apart}");
            let moon = Moon::at(moonlit.unwrap(), 55.6761, 12.5683).unwrap();
            let limb = moon.apparent_elevation_deg + moon.angular_diameter_deg() / 2.0;
            assert!(limb.abs() < 0.01, "{limb}");
            assert!(moon.illuminated_fraction() > 0.99);
        }
    }

    #[test]
    fn the_disc_sums_up_to_its_illuminance_at_every_phase() {
        let toward = direction(120.0, 35.0);
        for phase_angle_deg in [0.0, 20.0, 60.0, 90.0, 120.0, 150.0] {
            let (sine, cosine) = f64::to_radians(phase_angle_deg).sin_cos();
            let (side, _) = toward.any_orthonormal_pair();
            let moon = Moon {
                azimuth_deg: 120.0,
                elevation_deg: 35.0,
                apparent_elevation_deg: 35.0,
                distance_km: 390_000.0,
                phase_angle_deg,
                sunward: side * sine - toward * cosine,
            };
            let light = moon.light(3.0);
            // Rings and columns of equal solid angle within the disc.
            let (rings, columns, radius) = (300, 400, light.angular_radius.sin());
            let (right, up) = toward.any_orthonormal_pair();
            let mut sum = DVec3::ZERO;
            for i in 0..rings * columns {
                let r = radius * ((f64::from(i / columns) + 0.5) / f64::from(rings)).sqrt();
                let (s, c) = (2.0 * PI * f64::from(i % columns) / f64::from(columns)).sin_cos();
                let dir = toward * (1.0 - r * r).sqrt() + (right * c + up * s) * r;
                sum += light.disc(dir);
            }
            let found = sum * (PI * radius * radius / f64::from(rings * columns));
            let error = (found / light.illuminance - 1.0).abs().max_element();
            assert!(error < 2e-3, "{phase_angle_deg} {error}");
        }
    }

    #[test]
    fn nonsense_is_refused() {
        let when = DateTime::parse_from_rfc3339("2026-01-03T10:00:00Z").unwrap();
        assert!(Moon::at(when, 91.0, 0.0).is_err());
        assert!(Moon::at(when, 0.0, f64::NAN).is_err());
    }
}
