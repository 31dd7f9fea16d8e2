//! Where the sun comes from: a place and a moment, the lecture's inputs, or a direction.

use chrono::{DateTime, FixedOffset};

use super::{Direction, Options, Place, SettingsError, SolarTime};
use crate::daylight::moment::default_moment;

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
        let place = o.place.unwrap_or_default();
        let Place {
            latitude,
            longitude,
        } = place;
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
        let wrong = |what: String| SettingsError(format!("--when: {what}"));
        let when = match o.when {
            Some(when) => when.at(place).map_err(wrong)?,
            None => default_moment(place),
        };
        Ok(Self::Place {
            latitude,
            longitude,
            when,
        })
    }
}
