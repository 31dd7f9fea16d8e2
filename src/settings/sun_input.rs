//! Where the sun comes from: a place and a moment, the lecture's inputs, or a direction.

use chrono::{DateTime, FixedOffset};

use super::{Direction, Options, Place, SettingsError, SolarTime, values};

/// The default place: the lecture's university, degrees.
const DEFAULT_PLACE: Place = Place {
    latitude: 55.79,
    longitude: 12.52,
};
/// The default moment: a summer afternoon there.
pub(super) const DEFAULT_WHEN: &str = "2026-06-21T15:00:00+02:00";

/// Where the sun comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SunInput {
    /// A place and a moment.
    Place {
        /// Degrees, north positive, −90..90.
        latitude: f64,
        /// Degrees, east positive, −180..180.
        longitude: f64,
        /// The moment, with its UTC offset.
        when: DateTime<FixedOffset>,
    },
    /// The lecture's inputs.
    Solar {
        /// Day of the year, 1..366.
        day: u32,
        /// Solar time, hours, 0..24.
        hours: f64,
        /// Degrees, north positive, −90..90.
        latitude: f64,
    },
    /// A direction.
    Direction {
        /// Degrees clockwise from north, 0..360.
        azimuth_deg: f64,
        /// Degrees above the horizon, −90..90.
        elevation_deg: f64,
    },
}

impl SunInput {
    /// What the options say of it, or the default place and moment.
    pub(super) fn of(o: &Options) -> Result<Self, SettingsError> {
        let Place {
            latitude,
            longitude,
        } = o.place.unwrap_or(DEFAULT_PLACE);
        if let Some(Direction {
            azimuth_deg,
            elevation_deg,
        }) = o.sun
        {
            return Ok(Self::Direction {
                azimuth_deg,
                elevation_deg,
            });
        }
        if let Some(SolarTime { day, hours }) = o.solar {
            return Ok(Self::Solar {
                day,
                hours,
                latitude,
            });
        }
        let when = o
            .when
            .map_or_else(|| values::when(DEFAULT_WHEN), Ok)
            .map_err(SettingsError)?;
        Ok(Self::Place {
            latitude,
            longitude,
            when,
        })
    }
}
