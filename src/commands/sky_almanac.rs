//! The times of the day and the moon, as part of the report of `skylight sky`.

use std::fmt::{self, Display, Formatter};

use chrono::{DateTime, FixedOffset};
use glam::DVec3;
use serde::Serialize;

use super::light::Light;
use super::sky_table::{line, with_unit};
use crate::daylight::colour::luminance;
use crate::daylight::day_times::{DayTimes, Passage, Spans};
use crate::daylight::moon::{Moon, MoonEvents, Moonlight, moon_events};
use crate::error::Result;

type Moment = Option<DateTime<FixedOffset>>;

/// A moment as RFC 3339 to the second.
pub(super) fn rfc3339(moment: Moment) -> Option<String> {
    moment.map(|t| t.format("%Y-%m-%dT%H:%M:%S%:z").to_string())
}

/// The times of the date, and the moon at the moment.
#[derive(Debug, Serialize)]
pub struct Almanac {
    pub times: Times,
    pub moon: MoonPart,
}

/// Moments in the UTC offset of --when, each `None` if the sun does not pass its elevation on the date.
#[derive(Debug, Serialize)]
pub struct Times {
    /// The sun at -6°.
    pub civil_twilight: Twilight,
    /// The sun at -12°.
    pub nautical_twilight: Twilight,
    /// The sun at -18°.
    pub astronomical_twilight: Twilight,
    /// The sun between -6° and -4°.
    pub blue_hour: Hours,
    /// The sun between -4° and 6°.
    pub golden_hour: Hours,
}

#[derive(Debug, Serialize)]
pub struct Twilight {
    pub dawn: Option<String>,
    pub dusk: Option<String>,
    /// "above" or "below" if the sun does not pass this elevation on the date.
    pub sun_stays: Option<&'static str>,
    #[serde(skip)]
    passage: Passage,
}

/// Begin and end.
#[derive(Debug, Serialize)]
pub struct Hours {
    pub morning: [Option<String>; 2],
    pub evening: [Option<String>; 2],
    #[serde(skip)]
    spans: Spans,
}

#[derive(Debug, Serialize)]
pub struct MoonPart {
    pub azimuth_deg: f64,
    /// True elevation, without refraction, degrees.
    pub elevation_deg: f64,
    pub apparent_elevation_deg: f64,
    pub direction: [f64; 3],
    pub distance_km: f64,
    pub angular_diameter_deg: f64,
    /// 0 full, 180 new.
    pub phase_angle_deg: f64,
    pub illuminated_fraction: f64,
    /// Visual magnitude outside the air.
    pub magnitude: f64,
    /// Illuminance at normal incidence outside the air, lux.
    pub outside_lux: f64,
    /// Illuminance at normal incidence on the ground, lux; 0 below the horizon, behind clouds, and with --moon off.
    pub illuminance_lux: f64,
    pub illuminance_rgb: [f64; 3],
    /// Direct illuminance of a horizontal plane, lux.
    pub direct_horizontal_lux: f64,
    pub moonrise: Option<String>,
    pub moonset: Option<String>,
}

impl Almanac {
    /// `None` if the sun is not given by a place and a moment.
    ///
    /// # Errors
    /// A date that the ephemeris does not cover.
    pub fn new(light: &Light) -> Result<Option<Self>> {
        let Some((latitude, longitude, when)) = light.settings.sun.place() else {
            return Ok(None);
        };
        let (date, offset) = (when.date_naive(), *when.offset());
        let times = DayTimes::of(date, offset, latitude, longitude)?;
        let moon = match light.conditions.moon {
            Some(moon) => moon,
            None => Moon::at(when, latitude, longitude)?,
        };
        let events = moon_events(date, offset, latitude, longitude)?;
        Ok(Some(Self {
            times: Times::new(&times),
            moon: MoonPart::new(&moon, &events, light.daylight.moon),
        }))
    }
}

impl Times {
    fn new(times: &DayTimes) -> Self {
        let [civil, nautical, astronomical] = times.twilights.map(Twilight::new);
        Self {
            civil_twilight: civil,
            nautical_twilight: nautical,
            astronomical_twilight: astronomical,
            blue_hour: Hours::new(times.blue_hour),
            golden_hour: Hours::new(times.golden_hour),
        }
    }
}

impl Twilight {
    fn new(passage: Passage) -> Self {
        let stays = |above| if above { "above" } else { "below" };
        Self {
            dawn: rfc3339(passage.upward),
            dusk: rfc3339(passage.downward),
            sun_stays: passage.stays_above.map(stays),
            passage,
        }
    }
}

impl Hours {
    fn new(spans: Spans) -> Self {
        Self {
            morning: spans.morning.map(rfc3339),
            evening: spans.evening.map(rfc3339),
            spans,
        }
    }
}

impl MoonPart {
    fn new(moon: &Moon, events: &MoonEvents, light: Option<Moonlight>) -> Self {
        let rgb = light.map_or(DVec3::ZERO, |light| light.illuminance);
        let (illuminance, direction) = (luminance(rgb), moon.direction());
        Self {
            azimuth_deg: moon.azimuth_deg,
            elevation_deg: moon.elevation_deg,
            apparent_elevation_deg: moon.apparent_elevation_deg,
            direction: direction.to_array(),
            distance_km: moon.distance_km,
            angular_diameter_deg: moon.angular_diameter_deg(),
            phase_angle_deg: moon.phase_angle_deg,
            illuminated_fraction: moon.illuminated_fraction(),
            magnitude: moon.magnitude(),
            outside_lux: moon.outside_lux(),
            illuminance_lux: illuminance,
            illuminance_rgb: rgb.to_array(),
            direct_horizontal_lux: illuminance * direction.y.max(0.0),
            moonrise: rfc3339(events.rise),
            moonset: rfc3339(events.set),
        }
    }
}

fn clock(moment: Moment) -> String {
    moment.map_or_else(|| "none".to_owned(), |t| t.format("%H:%M:%S").to_string())
}

impl Display for Almanac {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { times, moon } = self;
        for (name, twilight) in [
            ("civil twilight", &times.civil_twilight),
            ("nautical twilight", &times.nautical_twilight),
            ("astronomical twilight", &times.astronomical_twilight),
        ] {
            line(f, name, twilight)?;
        }
        line(f, "blue hour", &times.blue_hour)?;
        line(f, "golden hour", &times.golden_hour)?;
        writeln!(f)?;
        moon.fmt(f)
    }
}

impl Display for Twilight {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let passage = &self.passage;
        match self.sun_stays {
            Some(stays) => write!(f, "none: the sun stays {stays} {}°", passage.elevation_deg),
            None => {
                let (dawn, dusk) = (clock(passage.upward), clock(passage.downward));
                write!(f, "dawn {dawn}, dusk {dusk}")
            }
        }
    }
}

impl Display for Hours {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let span = |[begin, end]: [Moment; 2]| match (begin, end) {
            (None, None) => "none".to_owned(),
            _ => format!("{} to {}", clock(begin), clock(end)),
        };
        let Spans { morning, evening } = self.spans;
        write!(f, "{}, {}", span(morning), span(evening))
    }
}

impl Display for MoonPart {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let (seen, truth) = (self.apparent_elevation_deg, self.elevation_deg);
        let elevation = format!("{seen:.3}° (true {truth:.3}°)");
        let disc = format!(
            "{:.3}° wide, {:.0} km away",
            self.angular_diameter_deg, self.distance_km
        );
        let phase = format!(
            "{:.1} % lit, phase angle {:.2}°",
            100.0 * self.illuminated_fraction,
            self.phase_angle_deg
        );
        let outside = format!(
            "{}, magnitude {:.2}",
            with_unit(self.outside_lux, "lux"),
            self.magnitude
        );
        let none = "none on this date";
        line(f, "moon's azimuth", format!("{:.3}°", self.azimuth_deg))?;
        line(f, "moon's elevation", elevation)?;
        line(f, "moon's disc", disc)?;
        line(f, "moon's phase", phase)?;
        line(f, "moon, outside the air", outside)?;
        line(
            f,
            "moon, normal incidence",
            with_unit(self.illuminance_lux, "lux"),
        )?;
        line(
            f,
            "moon, horizontal",
            with_unit(self.direct_horizontal_lux, "lux"),
        )?;
        line(f, "moonrise", self.moonrise.as_deref().unwrap_or(none))?;
        line(f, "moonset", self.moonset.as_deref().unwrap_or(none))
    }
}
