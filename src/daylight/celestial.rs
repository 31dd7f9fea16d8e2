//! From the celestial sphere to the sky of a place: precession and nutation of IAU 2000B, the rotation of the earth, latitude and longitude.

use chrono::{DateTime, FixedOffset};
use glam::{DMat3, DVec3};

use super::sun_position::{SunPositionError, check, delta_t_s, without_leap};

/// The Julian date of 1970-01-01T00:00Z.
pub(super) const UNIX_EPOCH_JD: f64 = 2_440_587.5;

/// A moment in the time scales of the ephemerides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Instant {
    /// Terrestrial time, days after [`UNIX_EPOCH_JD`].
    pub terrestrial: f64,
    /// Days of UTC after it, taken for those of UT1: within 0.9 s.
    universal: f64,
}

impl Instant {
    /// # Errors
    /// A year outside of [`super::sun_position::YEARS`].
    pub fn of(when: DateTime<FixedOffset>) -> Result<Self, SunPositionError> {
        let when = without_leap(when);
        let universal = when.timestamp_micros() as f64 / 86_400e6;
        let delta_t_days = delta_t_s(when.date_naive())? / 86_400.0;
        Ok(Self {
            terrestrial: universal + delta_t_days,
            universal,
        })
    }

    /// From the celestial frame (J2000) to that which turns with the earth: z to the north pole, x to longitude 0.
    pub fn earth_from_celestial(&self) -> DMat3 {
        let (jd, tt, ut) = (UNIX_EPOCH_JD, self.terrestrial, self.universal);
        let rows = sofars::pnp::c2t00b(jd, tt, jd, ut, 0.0, 0.0);
        DMat3::from_cols_array_2d(&rows).transpose()
    }
}

/// From the frame of the earth to world space (east, up, south) at a place, degrees.
///
/// # Errors
/// Coordinates out of range.
pub(super) fn world_from_earth(latitude: f64, longitude: f64) -> Result<DMat3, SunPositionError> {
    check(latitude, longitude)?;
    let (sin_lat, cos_lat) = latitude.to_radians().sin_cos();
    let (sin_lon, cos_lon) = longitude.to_radians().sin_cos();
    let east = DVec3::new(-sin_lon, cos_lon, 0.0);
    let up = DVec3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat);
    Ok(DMat3::from_cols(east, up, east.cross(up)).transpose())
}
