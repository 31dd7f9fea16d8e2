//! Where the sun comes from: a place and a moment, the lecture's inputs, or a direction.

use chrono::{DateTime, FixedOffset};
use clap::{ArgMatches, Args, Command, FromArgMatches};

use super::{Direction, OptionGroup, Place, SolarTime, options, values};

/// The default place: the lecture's university, degrees.
const DEFAULT_PLACE: Place = Place {
    latitude: 55.79,
    longitude: 12.52,
};
/// The default moment: a summer afternoon there.
const DEFAULT_WHEN: &str = "2026-06-21T15:00:00+02:00";

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
            /// Latitude and longitude, degrees, north and east positive, or the name of a city.
            #[arg(value_name = "LAT,LON|CITY", value_parser = values::place, allow_hyphen_values = true,
                  default_value_t = DEFAULT_PLACE)]
            place: Place,
            /// Moment with its UTC offset.
            #[arg(value_name = "MOMENT", value_parser = values::when, default_value = DEFAULT_WHEN)]
            when: DateTime<FixedOffset>,
            /// Day of the year and solar time in hours, with the latitude of --place.
            #[arg(value_name = "J,T", value_parser = values::solar, conflicts_with = "when")]
            solar: Option<SolarTime>,
        }
        "Sun and sky" ["sun", "moment"] {
            /// Direction of the sun, degrees: azimuth clockwise from north, elevation above the horizon.
            #[arg(value_name = "AZIMUTH,ELEVATION", value_parser = values::sun, allow_hyphen_values = true,
                  conflicts_with_all = ["place", "when", "solar"])]
            sun: Option<Direction>,
        }
    }
}

impl SunInput {
    /// What the options say of it.
    fn of(o: &SunArgs) -> Self {
        let Place {
            latitude,
            longitude,
        } = o.place;
        if let Some(Direction {
            azimuth_deg,
            elevation_deg,
        }) = o.sun
        {
            return Self::Direction {
                azimuth_deg,
                elevation_deg,
            };
        }
        if let Some(SolarTime { day, hours }) = o.solar {
            return Self::Solar {
                day,
                hours,
                latitude,
            };
        }
        Self::Place {
            latitude,
            longitude,
            when: o.when,
        }
    }
}

/// The default place and moment.
impl Default for SunInput {
    fn default() -> Self {
        let Place {
            latitude,
            longitude,
        } = DEFAULT_PLACE;
        let when = values::when(DEFAULT_WHEN);
        Self::Place {
            latitude,
            longitude,
            when: when.unwrap_or_else(|what| unreachable!("{what}")),
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
        Ok(Self::of(&SunArgs::from_arg_matches(matches)?))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
