//! The source of the sun's position: a place and a moment, the lecture's inputs, or a direction.

use chrono::{DateTime, Datelike, FixedOffset};
use clap::error::ErrorKind;
use clap::{ArgMatches, Args, Command, FromArgMatches};

use super::{Direction, OptionGroup, Place, SolarTime, When, options, values};
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

options! {
    /// The options that say where the sun comes from.
    struct SunArgs {
        "Sun and sky" ["place", "sun", "moment"] {
            /// Latitude and longitude, degrees, north and east positive (-33.87,151.21 or "33.87 S, 151.21 E"), or the name of a city.
            #[arg(value_name = "LAT,LON|CITY", value_parser = Place::parse, allow_hyphen_values = true, default_value_t)]
            place: Place,
            /// Date and time: with a UTC offset (2026-12-21T15:00+01:00), with a time zone ("2026-12-21 15:00 Asia/Tokyo"), or in
            /// local time of --place ("2026-12-21 15:00"). A place has the time zone of the nearest listed city within 1000 km,
            /// else the whole hour of its longitude. Years -500 to 3000; by default 15:00 local time on 2026-06-21.
            #[arg(value_name = "MOMENT", allow_hyphen_values = true)]
            when: Option<When>,
            /// Day of the year and solar time in hours, with the latitude of --place.
            #[arg(value_name = "J,T", value_parser = values::solar, conflicts_with = "when")]
            solar: Option<SolarTime>,
        }
        "Sun and sky" ["sun", "moment"] {
            /// Direction of the sun, degrees: azimuth clockwise from north, elevation above the horizon; the true elevation, and no refraction is added
            /// for the disc.
            #[arg(value_name = "AZIMUTH,ELEVATION", value_parser = values::sun, allow_hyphen_values = true,
                  conflicts_with_all = ["place", "when", "solar"])]
            sun: Option<Direction>,
        }
    }
}

impl SunInput {
    /// Latitude and longitude, degrees, and the moment; `None` if the sun is given without them.
    pub fn place(&self) -> Option<(f64, f64, DateTime<FixedOffset>)> {
        match *self {
            Self::Place {
                latitude,
                longitude,
                when,
            } => Some((latitude, longitude, when)),
            Self::Solar { .. } | Self::Direction { .. } => None,
        }
    }

    /// Day of the year, 1..=366, at the place's own clock; `None` for a direction.
    pub fn day_of_year(&self) -> Option<u32> {
        match *self {
            Self::Place { when, .. } => Some(when.ordinal()),
            Self::Solar { day, .. } => Some(day),
            Self::Direction { .. } => None,
        }
    }

    /// The sun input given by the options; an error says what is wrong with it.
    fn of(o: &SunArgs) -> Result<Self, String> {
        let place = o.place;
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
        let when = match o.when {
            Some(when) => when.at(place).map_err(|what| format!("--when: {what}"))?,
            None => default_moment(place),
        };
        Ok(Self::Place {
            latitude,
            longitude,
            when,
        })
    }
}

/// The default place and its default moment.
impl Default for SunInput {
    fn default() -> Self {
        let place = Place::default();
        Self::Place {
            latitude: place.latitude,
            longitude: place.longitude,
            when: default_moment(place),
        }
    }
}

impl OptionGroup for SunInput {
    const TABLES: &'static [(&'static str, &'static [&'static str])] = SunArgs::TABLES;

    fn written(&self) -> Vec<(String, String)> {
        let list = match *self {
            Self::Place {
                latitude,
                longitude,
                when,
            } => vec![
                ("place", format!("{latitude},{longitude}")),
                ("when", when.to_rfc3339()),
            ],
            Self::Solar {
                day,
                hours,
                latitude,
            } => vec![
                ("place", format!("{latitude},0")),
                ("solar", format!("{day},{hours}")),
            ],
            Self::Direction {
                azimuth_deg,
                elevation_deg,
            } => vec![("sun", format!("{azimuth_deg},{elevation_deg}"))],
        };
        let owned = |(name, text): (&str, String)| (name.to_owned(), text);
        list.into_iter().map(owned).collect()
    }
}

impl Args for SunInput {
    fn augment_args(command: Command) -> Command {
        SunArgs::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        SunArgs::augment_args_for_update(command)
    }
}

impl FromArgMatches for SunInput {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let input = Self::of(&SunArgs::from_arg_matches(matches)?);
        input.map_err(|what| clap::Error::raw(ErrorKind::ValueValidation, what))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
