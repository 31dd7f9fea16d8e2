//! Position of the sun from a place and a moment, by NREL's SPA or by the lecture's formulas.
//!
//! Angles are degrees: latitude positive north, longitude positive east, azimuth clockwise from north.
//! World: +Y up, +X east, -Z north.
//!
//! # The error in the published formula
//!
//! The lecture's slide (and its source, A.6 of Preetham et al. 1999) gives the azimuth as
//! `arctan(-cos δ sin(πt/12) / (cos ℓ sin δ - sin ℓ cos δ cos(πt/12)))`. The first term of the denominator must be
//! **negative**: as printed, the formula mirrors the declination, so that a summer sunrise is in the south-east (mean error
//! over daytime 21°, worst 80°). The printed and corrected forms agree only at the equinoxes and on the meridian. Also,
//! `arctan` of the quotient loses the quadrant: it must be `atan2`. [`lecture`] computes the corrected form; its φ counts from
//! south toward west, so the azimuth is 180° + φ.

use chrono::{DateTime, Datelike, Duration, FixedOffset, NaiveDate, Timelike};
use glam::DVec3;
use solar_positioning::{Events, Horizon, Location, SolarEvents, SolarPositions, delta_t};
use std::f64::consts::PI;
use std::ops::RangeInclusive;

/// Years for which the formulas are valid: those of the ΔT estimates.
pub const YEARS: RangeInclusive<i32> = -500..=3000;

/// Air pressure for [`refraction_deg`], hPa.
pub const PRESSURE_HPA: f64 = 1013.25;

/// Air temperature for [`refraction_deg`], °C.
pub const TEMPERATURE_C: f64 = 12.0;

/// Formulas of the sun's position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SunPositionMethod {
    /// NREL's Solar Position Algorithm (Reda & Andreas 2004): 0.0003°.
    #[default]
    Spa,
    /// The lecture's formulas (Preetham et al. 1999, A.6), azimuth corrected: 0.3° typical, 1.2° worst.
    Lecture,
}

impl SunPositionMethod {
    /// Position of the sun by this method at `when`, seen from `latitude` (±90°) and `longitude` (±180°).
    ///
    /// # Errors
    /// Coordinates out of range; for SPA a year outside of [`YEARS`].
    pub fn position(
        self,
        when: DateTime<FixedOffset>,
        latitude: f64,
        longitude: f64,
    ) -> Result<SunPosition, SunPositionError> {
        match self {
            Self::Spa => spa(when, latitude, longitude),
            Self::Lecture => {
                check(latitude, longitude)?;
                let solar = solar_time(when, longitude);
                Ok(lecture(solar.day_of_year, solar.hours, latitude))
            }
        }
    }
}

/// Reasons why a sun position cannot be computed.
#[derive(Debug, thiserror::Error)]
pub enum SunPositionError {
    /// Latitude outside ±90°, or NaN.
    #[error("latitude {0} is not in -90..=90 degrees")]
    Latitude(f64),
    /// Longitude outside ±180°, or NaN.
    #[error("longitude {0} is not in -180..=180 degrees")]
    Longitude(f64),
    /// A year outside of [`YEARS`].
    #[error(
        "no sun position for this moment: the formulas hold for the years -500 to 3000, not for {0}"
    )]
    Year(i32),
    /// Any other failure of the algorithm.
    #[error("no sun position for this moment: {0}")]
    Moment(#[from] solar_positioning::Error),
}

/// Position of the sun's centre in the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunPosition {
    /// Azimuth, degrees in 0..360, clockwise from north.
    pub azimuth_deg: f64,
    /// True (geometric) elevation over the horizon, degrees in -90..=90.
    pub elevation_deg: f64,
    /// Apparent elevation, degrees: the true one plus [`refraction_deg`].
    pub apparent_elevation_deg: f64,
}

impl SunPosition {
    /// A position from azimuth and true elevation, degrees; derives the apparent elevation.
    pub fn from_true(azimuth_deg: f64, elevation_deg: f64) -> Self {
        Self {
            azimuth_deg: azimuth_deg.rem_euclid(360.0),
            elevation_deg,
            apparent_elevation_deg: elevation_deg + refraction_deg(elevation_deg),
        }
    }

    /// Unit vector toward the apparent sun, in world space.
    pub fn direction(&self) -> DVec3 {
        direction(self.azimuth_deg, self.apparent_elevation_deg)
    }
}

/// Unit vector toward (azimuth, elevation), degrees: (sin az cos el, sin el, -cos az cos el).
pub fn direction(azimuth_deg: f64, elevation_deg: f64) -> DVec3 {
    let (sin_az, cos_az) = azimuth_deg.to_radians().sin_cos();
    let (sin_el, cos_el) = elevation_deg.to_radians().sin_cos();
    DVec3::new(sin_az * cos_el, sin_el, -cos_az * cos_el)
}

/// (azimuth in 0..360, elevation in -90..=90) of a vector, degrees; the inverse of [`direction`]. The azimuth of straight up or
/// down is 0.
pub fn azimuth_elevation(direction: DVec3) -> (f64, f64) {
    let horizontal = direction.x.hypot(direction.z);
    let azimuth = if horizontal > 0.0 {
        direction.x.atan2(-direction.z).to_degrees()
    } else {
        0.0
    };
    let azimuth = azimuth.rem_euclid(360.0);
    // A tiny negative angle rounds up to a full turn.
    let azimuth = if azimuth >= 360.0 { 0.0 } else { azimuth };
    (azimuth, direction.y.atan2(horizontal).to_degrees())
}

/// Reda & Andreas 2004, eq. 42 (Sæmundsson 1986): atmospheric refraction at 1013.25 hPa and 12 °C, degrees.
///
/// SPA sets refraction to 0 once the upper limb has set (-0.8333°), a jump of 0.6°. Here it fades to 0 at -3°, so that an
/// animated sunset has no jump; above -0.8333° the values are SPA's.
pub fn refraction_deg(true_elevation_deg: f64) -> f64 {
    const CUTOFF: f64 = -(0.266_67 + 0.566_7);
    const GONE: f64 = -3.0;
    if true_elevation_deg < CUTOFF {
        let fade = ((true_elevation_deg - GONE) / (CUTOFF - GONE)).max(0.0);
        return refraction_deg(CUTOFF) * fade;
    }
    let e = true_elevation_deg;
    let air = (PRESSURE_HPA / 1010.0) * (283.0 / (273.0 + TEMPERATURE_C));
    air * 1.02 / (60.0 * (e + 10.3 / (e + 5.11)).to_radians().tan())
}

/// Reda & Andreas 2004: NREL's Solar Position Algorithm, by the crate `solar-positioning`, at sea level.
///
/// Terrestrial time is UT plus an estimated ΔT (Espenak & Meeus). UTC is used as UT1: a leap second counts as the next second.
///
/// # Errors
/// Coordinates out of range, or a year outside [`YEARS`].
pub fn spa(
    when: DateTime<FixedOffset>,
    latitude: f64,
    longitude: f64,
) -> Result<SunPosition, SunPositionError> {
    let location = check(latitude, longitude)?;
    let delta_t = delta_t_s(when.date_naive())?;
    let seen = SolarPositions::new().at(&without_leap(when), location, 0.0, delta_t, None)?;
    Ok(SunPosition::from_true(
        seen.azimuth(),
        seen.elevation_angle(),
    ))
}

/// Estimate of ΔT, terrestrial minus universal time, seconds, for the month of a date.
pub(super) fn delta_t_s(date: NaiveDate) -> Result<f64, SunPositionError> {
    let year = date.year();
    if !YEARS.contains(&year) {
        return Err(SunPositionError::Year(year));
    }
    // The polynomials end at the start of the last year; by its end they would grow by 10 s, in which the sun moves 0.0001°.
    if year == *YEARS.end() {
        return Ok(delta_t::estimate(f64::from(year))?);
    }
    Ok(delta_t::estimate_from_date_like(&date)?)
}

/// A leap second as the following second: chrono represents it by nanoseconds beyond the previous second.
pub(super) fn without_leap(when: DateTime<FixedOffset>) -> DateTime<FixedOffset> {
    let leap = when.nanosecond() / 1_000_000_000;
    let before = when.with_nanosecond(when.nanosecond() % 1_000_000_000);
    let after = before.and_then(|w| w.checked_add_signed(Duration::seconds(i64::from(leap))));
    after.unwrap_or(when)
}

/// The place, if its coordinates are in range.
pub(super) fn check(latitude: f64, longitude: f64) -> Result<Location, SunPositionError> {
    if !(-90.0..=90.0).contains(&latitude) {
        return Err(SunPositionError::Latitude(latitude));
    }
    if !(-180.0..=180.0).contains(&longitude) {
        return Err(SunPositionError::Longitude(longitude));
    }
    Ok(Location {
        latitude,
        longitude,
    })
}

/// Spencer 1971: the sun's irradiance outside the air relative to that at its mean distance, 0.967..=1.035, on a day of the
/// year (1..=366): the inverse square of the distance in astronomical units.
pub fn distance_factor(day_of_year: u32) -> f64 {
    let angle = 2.0 * PI * (f64::from(day_of_year) - 1.0) / 365.0;
    let (twice, once) = (2.0 * angle, angle);
    1.00011
        + 0.034221 * once.cos()
        + 0.00128 * once.sin()
        + 0.000719 * twice.cos()
        + 0.000077 * twice.sin()
}

/// Preetham et al. 1999, A.6 (the lecture's slide "Solar position"), azimuth corrected (see the module).
///
/// `day_of_year` is J in 1..=366, `solar_time_h` is t in hours (12 when the sun is on the meridian),
/// `latitude` in degrees. θ_s = π/2 - asin(sin ℓ sin δ - cos ℓ cos δ cos(πt/12)).
pub fn lecture(day_of_year: u32, solar_time_h: f64, latitude: f64) -> SunPosition {
    let (sin_d, cos_d) = declination(day_of_year).sin_cos();
    let (sin_l, cos_l) = latitude.to_radians().sin_cos();
    let (sin_t, cos_t) = (PI * solar_time_h / 12.0).sin_cos();
    let sin_elevation = sin_l * sin_d - cos_l * cos_d * cos_t;
    // Printed as cos ℓ sin δ - ..., with the wrong sign.
    let west_of_south = (-cos_d * sin_t).atan2(-cos_l * sin_d - sin_l * cos_d * cos_t);
    SunPosition::from_true(
        180.0 + west_of_south.to_degrees(),
        sin_elevation.clamp(-1.0, 1.0).asin().to_degrees(),
    )
}

/// Preetham et al. 1999, A.6: solar declination δ in radians, ±0.4093, on day J of the year.
pub fn declination(day_of_year: u32) -> f64 {
    0.4093 * (2.0 * PI * (f64::from(day_of_year) - 81.0) / 368.0).sin()
}

/// Preetham et al. 1999, A.6: equation of time in hours (about ±0.27) on day J: sundial minus clock.
pub fn equation_of_time(day_of_year: u32) -> f64 {
    let j = f64::from(day_of_year);
    0.170 * (4.0 * PI * (j - 80.0) / 373.0).sin() - 0.129 * (2.0 * PI * (j - 8.0) / 355.0).sin()
}

/// The lecture's inputs: day of the year and solar time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolarTime {
    /// J, the day of the year in 1..=366 at the place's own meridian (not the astronomers' Julian date).
    pub day_of_year: u32,
    /// t, hours in 0..24; 12 when the sun is on the meridian.
    pub hours: f64,
}

/// Preetham et al. 1999, A.6: solar time at `longitude` (degrees, positive **east**) at `when`.
///
/// The paper writes t = t_s + EoT + 12 (SM - L)/π with zone standard time t_s and longitudes positive to the *west*.
/// A moment with its UTC offset needs neither zone meridian nor summer time: t = UTC + EoT + L/15.
pub fn solar_time(when: DateTime<FixedOffset>, longitude: f64) -> SolarTime {
    let seconds = longitude / 15.0 * 3600.0;
    let utc = when.naive_utc();
    let shift = Duration::milliseconds((seconds * 1000.0).round() as i64);
    // chrono's calendar ends in the year 262 142.
    let mean_time = utc.checked_add_signed(shift).unwrap_or(utc);
    let clock = mean_time.time();
    let hours = f64::from(clock.num_seconds_from_midnight()) / 3600.0
        + f64::from(clock.nanosecond()) / 3.6e12;
    let day_of_year = mean_time.ordinal();
    SolarTime {
        day_of_year,
        hours: (hours + equation_of_time(day_of_year)).rem_euclid(24.0),
    }
}

/// Sunrise, solar noon and sunset of one calendar day.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunEvents {
    /// The upper limb appears (true elevation -0.8333°); `None` in polar day or night.
    pub sunrise: Option<DateTime<FixedOffset>>,
    /// The sun crosses the meridian.
    pub noon: Option<DateTime<FixedOffset>>,
    /// The upper limb vanishes; `None` in polar day or night.
    pub sunset: Option<DateTime<FixedOffset>>,
}

/// A day without sunrise and sunset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Polar {
    /// The sun stays above the horizon.
    Day,
    /// The sun stays below the horizon.
    Night,
}

impl SunEvents {
    /// Polar day or night at the place of the events; `None` on a day with sunrise or sunset.
    pub fn polar(&self, latitude: f64, longitude: f64) -> Option<Polar> {
        if self.sunrise.is_some() || self.sunset.is_some() {
            return None;
        }
        // The sun is highest at solar noon.
        let noon = spa(self.noon?, latitude, longitude).ok()?;
        Some(if noon.apparent_elevation_deg > 0.0 {
            Polar::Day
        } else {
            Polar::Night
        })
    }
}

/// When the sun passes a horizon on the calendar day of `date` in the time zone `offset`, by SPA.
pub(super) fn events_at(
    date: NaiveDate,
    offset: FixedOffset,
    latitude: f64,
    longitude: f64,
    horizon: Horizon,
) -> Result<Events<DateTime<FixedOffset>>, SunPositionError> {
    let location = check(latitude, longitude)?;
    let delta_t = delta_t_s(date)?;
    Ok(SolarEvents::new().for_date(date, &offset, location, delta_t, horizon)?)
}

/// Sunrise, solar noon and sunset on the calendar day of `date` in the time zone `offset`, by SPA.
pub fn sun_events(
    date: NaiveDate,
    offset: FixedOffset,
    latitude: f64,
    longitude: f64,
) -> Result<SunEvents, SunPositionError> {
    let day = events_at(date, offset, latitude, longitude, Horizon::SunriseSunset)?;
    Ok(SunEvents {
        sunrise: day.rises.first().copied(),
        noon: day.transits.first().copied(),
        sunset: day.sets.first().copied(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moment(text: &str) -> DateTime<FixedOffset> {
        DateTime::parse_from_rfc3339(text).unwrap()
    }

    #[test]
    fn cardinal_directions() {
        let cases = [
            (0.0, DVec3::NEG_Z),
            (90.0, DVec3::X),
            (180.0, DVec3::Z),
            (270.0, DVec3::NEG_X),
        ];
        for (azimuth, expected) in cases {
            assert!(
                (direction(azimuth, 0.0) - expected).length() < 1e-15,
                "{azimuth}"
            );
        }
        assert!((direction(123.0, 90.0) - DVec3::Y).length() < 1e-15);
    }

    #[test]
    fn direction_has_an_inverse() {
        for az in 0..360 {
            for el in -89..90 {
                let (a, e) = azimuth_elevation(direction(f64::from(az), f64::from(el)));
                let turn = (a - f64::from(az) + 180.0).rem_euclid(360.0) - 180.0;
                assert!(
                    turn.abs() < 1e-11 && (e - f64::from(el)).abs() < 1e-12,
                    "{az} {el} {a} {e}"
                );
            }
        }
        assert_eq!(azimuth_elevation(DVec3::Y), (0.0, 90.0));
    }

    #[test]
    fn the_printed_azimuth_mirrors_a_summer_sunrise() {
        // 21 June at 40° north, 6 h solar time: the sun has risen in the north-east.
        let morning = lecture(172, 6.0, 40.0);
        assert!((morning.azimuth_deg - 71.62).abs() < 0.01, "{morning:?}");
        let (d, l, t): (f64, f64, f64) = (declination(172), 40f64.to_radians(), PI * 6.0 / 12.0);
        let printed = (-d.cos() * t.sin()).atan2(l.cos() * d.sin() - l.sin() * d.cos() * t.cos());
        assert!(
            (180.0 + printed.to_degrees() - 108.38).abs() < 0.01,
            "{printed}"
        );
    }

    #[test]
    fn refraction_lifts_the_setting_sun_and_has_no_jump() {
        assert!(
            (refraction_deg(0.0) - 0.48).abs() < 0.01,
            "{}",
            refraction_deg(0.0)
        );
        let mut before = -90.0;
        for i in -9000..=9000 {
            let true_elevation = f64::from(i) / 100.0;
            let apparent = true_elevation + refraction_deg(true_elevation);
            assert!(
                apparent >= before && apparent - before < 0.02,
                "{true_elevation}"
            );
            before = apparent;
        }
        assert_eq!(refraction_deg(-3.0), 0.0);
    }

    #[test]
    fn solar_time_does_not_depend_on_the_offset_of_the_clock() {
        let summer = solar_time(moment("2026-06-21T14:00:00+02:00"), 12.5683);
        let utc = solar_time(moment("2026-06-21T12:00:00Z"), 12.5683);
        assert_eq!(summer, utc);
        assert_eq!(summer.day_of_year, 172);
        assert!((summer.hours - (12.0 + 12.5683 / 15.0 + equation_of_time(172))).abs() < 1e-6);
    }

    #[test]
    fn midsummer_in_copenhagen() {
        let zone = FixedOffset::east_opt(2 * 3600).unwrap();
        let day = NaiveDate::from_ymd_opt(2026, 6, 21).unwrap();
        let events = sun_events(day, zone, 55.6761, 12.5683).unwrap();
        // Almanac: 04:25, 13:11, 21:57 (CEST).
        let minutes =
            |t: Option<DateTime<FixedOffset>>| t.map(|t| t.hour() * 60 + t.minute()).unwrap();
        assert!(
            minutes(events.sunrise).abs_diff(4 * 60 + 25) <= 1,
            "{events:?}"
        );
        assert!(
            minutes(events.noon).abs_diff(13 * 60 + 11) <= 1,
            "{events:?}"
        );
        assert!(
            minutes(events.sunset).abs_diff(21 * 60 + 57) <= 1,
            "{events:?}"
        );
        let polar = sun_events(day, zone, 78.2, 15.6).unwrap();
        assert!(polar.sunrise.is_none() && polar.sunset.is_none() && polar.noon.is_some());
    }

    #[test]
    fn the_whole_of_the_last_year_and_leap_seconds_have_a_sun() {
        let at = |text: &str| spa(moment(text), 55.79, 12.52);
        let date = |year, month, day| NaiveDate::from_ymd_opt(year, month, day).unwrap();
        let utc = FixedOffset::east_opt(0).unwrap();
        // Noon: 90° - latitude + declination.
        for (day, declination) in [
            (date(3000, 6, 21), 23.3),
            (date(3000, 12, 31), -23.0),
            (date(-500, 6, 21), 23.7),
        ] {
            let events = sun_events(day, utc, 55.79, 12.52).unwrap();
            let noon = spa(events.noon.unwrap(), 55.79, 12.52).unwrap();
            let expected = 90.0 - 55.79 + declination;
            assert!(
                (noon.elevation_deg - expected).abs() < 0.2,
                "{day}: {noon:?}"
            );
        }
        for day in [date(3000, 12, 31), date(-500, 1, 1)] {
            let events = sun_events(day, utc, 55.79, 12.52).unwrap();
            assert!(events.sunrise.is_some() && events.sunset.is_some());
        }
        // The sun turns by 0.004° in a second; the estimate of ΔT differs from month to month.
        for (leap, second) in [
            ("2016-12-31T23:59:60Z", "2017-01-01T00:00:00Z"),
            ("2016-12-31T23:59:60.5Z", "2017-01-01T00:00:00.5Z"),
        ] {
            let [leap, second] = [leap, second].map(|text| at(text).unwrap());
            assert!((leap.azimuth_deg - second.azimuth_deg).abs() < 1e-5);
            assert!((leap.elevation_deg - second.elevation_deg).abs() < 1e-5);
        }
        for text in ["3001-01-01T00:00:00Z", "9999-01-01T00:00:00Z"] {
            let error = at(text).unwrap_err().to_string();
            assert!(error.contains("the years -500 to 3000"), "{error}");
        }
        for end in [chrono::NaiveDateTime::MIN, chrono::NaiveDateTime::MAX] {
            let when = DateTime::from_naive_utc_and_offset(end, utc);
            assert!(spa(when, 0.0, 0.0).is_err());
            for longitude in [-180.0, 180.0] {
                assert!((0.0..24.0).contains(&solar_time(when, longitude).hours));
            }
        }
    }

    #[test]
    fn nonsense_places_are_named() {
        let when = moment("2026-06-21T12:00:00Z");
        for method in [SunPositionMethod::Spa, SunPositionMethod::Lecture] {
            assert!(matches!(
                method.position(when, 91.0, 0.0),
                Err(SunPositionError::Latitude(_))
            ));
            assert!(matches!(
                method.position(when, 0.0, f64::NAN),
                Err(SunPositionError::Longitude(_))
            ));
        }
    }
}
