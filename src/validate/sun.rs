//! The position of the sun, on the CPU.

use chrono::{DateTime, FixedOffset, TimeZone as _, Utc};
use glam::{DMat3, DVec3};

use super::check::Check;
use crate::daylight::preetham::angle_between;
use crate::daylight::sun_position::{self, SunPosition, SunPositionError, direction};

/// A position of the sun from a moment, a latitude and a longitude.
pub type Solver<'s> =
    &'s dyn Fn(DateTime<FixedOffset>, f64, f64) -> Result<SunPosition, SunPositionError>;

/// All checks of the sun's position.
///
/// # Errors
/// The solver refuses a moment or a place.
pub fn checks() -> Result<Vec<Check>, SunPositionError> {
    by(&sun_position::spa)
}

/// The same of another solver.
///
/// # Errors
/// As [`checks`].
pub fn by(solver: Solver<'_>) -> Result<Vec<Check>, SunPositionError> {
    Ok(vec![example(solver)?, seasons(solver)?, places(solver)?])
}

fn utc(y: i32, month: u32, day: u32, h: u32, m: u32, s: u32) -> Option<DateTime<FixedOffset>> {
    let moment = Utc.with_ymd_and_hms(y, month, day, h, m, s);
    moment.single().map(|moment| moment.fixed_offset())
}

/// The worked example of Reda & Andreas 2004 (NREL/TP-560-34302, table A5.1): 17 October 2003, 12:30:30 at UTC−7, 39.742476° N, 105.1786° W. Its
/// topocentric elevation without refraction is 39.872046°, its azimuth 194.340241°. It takes ΔT 67 s: 1e-5°.
fn example(solver: Solver<'_>) -> Result<Check, SunPositionError> {
    let mut check = Check::absolute("sun, SPA's example", "Reda & Andreas 2004", "°", 1e-3);
    if let Some(when) = utc(2003, 10, 17, 19, 30, 30) {
        let found = solver(when, 39.742476, -105.1786)?;
        check.see(found.azimuth_deg, 194.340241, 1.0, || "azimuth".to_owned());
        check.see(found.elevation_deg, 39.872046, 1.0, || {
            "elevation".to_owned()
        });
    }
    Ok(check)
}

/// Declinations at the equinoxes and solstices of 2026, whose minutes the almanacs publish: 0 and the obliquity of the ecliptic. From the pole
/// the elevation is the declination. Allowed are the parallax, 0.0024°, and the nutation, 0.0026°.
fn seasons(solver: Solver<'_>) -> Result<Check, SunPositionError> {
    let mut check = Check::absolute("sun, seasons of 2026", "almanac, obliquity", "°", 0.006);
    // IAU 2006: 23.439279° − 0.013010° a century.
    let obliquity = 23.439279 - 0.013010 * 0.265;
    for (when, declination) in [
        (utc(2026, 3, 20, 14, 46, 0), 0.0),
        (utc(2026, 6, 21, 8, 24, 0), obliquity),
        (utc(2026, 9, 23, 0, 5, 0), 0.0),
        (utc(2026, 12, 21, 20, 50, 0), -obliquity),
    ] {
        for (latitude, sign) in [(90.0, 1.0), (-90.0, -1.0)] {
            let Some(when) = when else { continue };
            let found = sign * solver(when, latitude, 0.0)?.elevation_deg;
            check.see(found, declination, 1.0, || format!("{when}, {latitude}°"));
        }
    }
    Ok(check)
}

/// The sun in axes fixed to the Earth is the same from everywhere but for its parallax: the closed form of the turn from a place's horizon to the
/// equator. The distance of 1 au, right to 1.7 %, and a spherical Earth leave 1e-4°.
fn places(solver: Solver<'_>) -> Result<Check, SunPositionError> {
    let mut check = Check::absolute("sun, from 72 places", "rotation, parallax", "°", 3e-4);
    for month in 1..=12 {
        let Some(when) = utc(2026, month, 21, 2 * month - 1, 17, 0) else {
            continue;
        };
        // The vector to the sun from a place, in radii of the Earth.
        let seen = |latitude: f64, longitude: f64| -> Result<[DVec3; 2], SunPositionError> {
            let found = solver(when, latitude, longitude)?;
            let turn = from_horizon(latitude, longitude);
            let local = direction(found.azimuth_deg, found.elevation_deg);
            Ok([turn * local * AU, turn.y_axis])
        };
        let [sun, place] = seen(0.0, 0.0)?;
        let sun = sun + place;
        for latitude in [-66.0, -23.0, 8.0, 41.0, 55.7, 80.0] {
            let longitude = f64::from(month) * 29.0 - 180.0;
            let [found, place] = seen(latitude, longitude)?;
            let angle = angle_between(found.normalize(), (sun - place).normalize());
            check.see(angle.to_degrees(), 0.0, 1.0, || {
                format!("{when}, {latitude}°, {longitude}°")
            });
        }
    }
    Ok(check)
}

/// Distance of the sun, radii of the Earth's equator.
const AU: f64 = 149_597_870.7 / 6378.137;

/// From east, up and south of a place to axes of the Earth: the equator at longitude 0, the pole, the equator at 90° W.
fn from_horizon(latitude: f64, longitude: f64) -> DMat3 {
    let (sin_lat, cos_lat) = latitude.to_radians().sin_cos();
    let (sin_lon, cos_lon) = longitude.to_radians().sin_cos();
    let up = DVec3::new(cos_lat * cos_lon, sin_lat, -cos_lat * sin_lon);
    let north = DVec3::new(-sin_lat * cos_lon, cos_lat, sin_lat * sin_lon);
    let east = north.cross(up);
    DMat3::from_cols(east, up, -north)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_is_where_it_belongs() {
        for check in checks().expect("a sun") {
            println!("{} {:e} at {}", check.name, check.error(), check.at());
            assert!(check.passed(), "{}: {}", check.name, check.error());
        }
    }

    /// Each check fails on the faults that it is there for.
    #[test]
    fn a_wrong_sun_is_seen() {
        let moved = |seen: SunPosition, azimuth: f64, elevation: f64| {
            SunPosition::from_true(seen.azimuth_deg + azimuth, seen.elevation_deg + elevation)
        };
        // An hour angle of 20 s; the latitude of the south; refraction counted twice; the longitude forgotten.
        let late = |when: DateTime<FixedOffset>, latitude, longitude| {
            sun_position::spa(when + chrono::Duration::seconds(20), latitude, longitude)
        };
        let low = |when, latitude, longitude| {
            Ok(moved(
                sun_position::spa(when, latitude, longitude)?,
                0.0,
                0.01,
            ))
        };
        let turned = |when, latitude, longitude| {
            Ok(moved(
                sun_position::spa(when, latitude, longitude)?,
                0.01,
                0.0,
            ))
        };
        let mirrored =
            |when, latitude, longitude: f64| sun_position::spa(when, latitude, -longitude);
        let failed = |solver: Solver<'_>| -> Vec<bool> {
            let checks = by(solver).expect("a sun");
            checks.iter().map(|check| !check.passed()).collect()
        };
        assert_eq!(failed(&late), [true, false, false]);
        assert_eq!(failed(&low), [true, true, true]);
        assert_eq!(failed(&turned), [true, false, true]);
        assert_eq!(failed(&mirrored), [true, false, true]);
    }
}
