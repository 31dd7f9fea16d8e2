//! Position of the sun: by place and time, by solar time, or as a direction.

use chrono::{DateTime, Datelike, FixedOffset, NaiveDate, NaiveDateTime, NaiveTime, Timelike};
use egui::{Color32, Key, Response, TextEdit, Ui, pos2, vec2};

use super::clock::{Clock, SPEEDS};
use super::numbers::{field, slider};
use super::year;
use crate::commands::view::document::Document;
use crate::commands::view::style;
use crate::daylight::cities;
use crate::daylight::place::{Axis, Place, Zone};
use crate::daylight::sun_position::{SunEvents, SunPosition, YEARS, sun_events};
use crate::options::{Options, SunInput};

/// Largest number of search results.
const MAX_FOUND: usize = 8;
/// Distance within which a place is named after a city, km.
const NEAR_KM: f64 = 30.0;

/// The place search field.
#[derive(Debug, Default)]
pub(super) struct PlaceField {
    text: String,
    /// Sunrise, noon and sunset, cached with the day they were computed for.
    events: Option<(Day, SunEvents)>,
}

/// A calendar day at a place: date, UTC offset (s), latitude and longitude (bits).
type Day = (NaiveDate, i32, [u64; 2]);

pub(super) fn show(
    ui: &mut Ui,
    document: &mut Document,
    field: &mut PlaceField,
    clock: &mut Clock,
) {
    let sun = document.job.sun;
    let settings = &mut document.job.settings;
    let year = document.year.as_mut();
    if year.is_some_and(|year| year::show(ui, year, settings)) {
        clock_buttons(ui, clock);
        position(ui, &sun);
        return;
    }
    kind(ui, settings, &sun);
    match &mut settings.sun {
        SunInput::Place {
            latitude,
            longitude,
            when,
        } => {
            field.show(ui, latitude, longitude, when);
            let place = Place {
                latitude: *latitude,
                longitude: *longitude,
            };
            date(ui, when, place.zone());
            let events = field.events(*when, place);
            time_of_day(ui, when, place.zone(), events.as_ref());
            clock_buttons(ui, clock);
            if let Some(events) = &events {
                ui.weak(events_text(events));
            }
        }
        SunInput::Solar {
            day,
            hours,
            latitude,
        } => {
            ui.add(slider(latitude, -90.0..=90.0).suffix("°").text("latitude"));
            ui.add(slider(day, 1..=365).text("day of the year"));
            ui.add(slider(hours, 0.0..=24.0).text("solar time, h"));
            clock_buttons(ui, clock);
        }
        SunInput::Direction {
            azimuth_deg,
            elevation_deg,
        } => {
            ui.add(slider(azimuth_deg, 0.0..=360.0).suffix("°").text("azimuth"));
            ui.add(
                slider(elevation_deg, -20.0..=90.0)
                    .suffix("°")
                    .text("elevation"),
            );
        }
    }
    position(ui, &sun);
}

/// Where the sun stands.
fn position(ui: &mut Ui, sun: &SunPosition) {
    ui.label(format!(
        "azimuth {:.1}°, elevation {:.1}°",
        sun.azimuth_deg, sun.apparent_elevation_deg
    ));
}

/// Switches between the three kinds of input, keeping what they have in common.
fn kind(ui: &mut Ui, settings: &mut Options, sun: &SunPosition) {
    let now = std::mem::discriminant(&settings.sun);
    let place = SunInput::default();
    let solar = solar_of(&settings.sun);
    let direction = SunInput::Direction {
        azimuth_deg: sun.azimuth_deg,
        elevation_deg: sun.apparent_elevation_deg,
    };
    ui.horizontal(|ui| {
        for (text, other) in [
            ("place and time", place),
            ("solar time", solar),
            ("direction", direction),
        ] {
            let is_now = std::mem::discriminant(&other) == now;
            if ui.selectable_label(is_now, text).clicked() && !is_now {
                settings.sun = other;
            }
        }
    });
}

/// Converts to solar time with the same day, time and latitude.
fn solar_of(sun: &SunInput) -> SunInput {
    match *sun {
        SunInput::Place {
            latitude,
            longitude,
            when,
        } => {
            let solar = crate::daylight::sun_position::solar_time(when, longitude);
            SunInput::Solar {
                day: solar.day_of_year,
                hours: solar.hours,
                latitude,
            }
        }
        _ => SunInput::Solar {
            day: 172,
            hours: 15.0,
            latitude: 45.0,
        },
    }
}

/// Interpretations of the text in the field: its coordinates, the matching cities, or else the city with the closest spelling.
fn suggestions(text: &str) -> Vec<(String, Place)> {
    if text.trim().is_empty() {
        return Vec::new();
    }
    if text.contains(|c: char| c.is_ascii_digit()) {
        let place = Place::parse(text).ok();
        return place.map(|p| (p.to_string(), p)).into_iter().collect();
    }
    let mut found = cities::search(text);
    if found.is_empty() {
        found.push(cities::alike(text));
    }
    let named = found.into_iter().map(|city| {
        let name = format!("{}, {}", city.name, city.country);
        let (latitude, longitude) = (city.latitude, city.longitude);
        (
            name,
            Place {
                latitude,
                longitude,
            },
        )
    });
    named.take(MAX_FOUND).collect()
}

impl PlaceField {
    /// The search field with its suggestions (Enter accepts the first), and the coordinates.
    fn show(
        &mut self,
        ui: &mut Ui,
        latitude: &mut f64,
        longitude: &mut f64,
        when: &mut DateTime<FixedOffset>,
    ) {
        let (city, km) = cities::nearest(*latitude, *longitude);
        let hint = if km < NEAR_KM {
            format!("{}, {}", city.name, city.country)
        } else {
            "search for a city".to_owned()
        };
        let field = ui.add(TextEdit::singleline(&mut self.text).hint_text(hint));
        let is_entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let mut chosen = None;
        for (i, (name, place)) in suggestions(&self.text).into_iter().enumerate() {
            let is_first = i == 0;
            if ui.selectable_label(is_first, name).clicked() || (is_first && is_entered) {
                chosen = Some(place);
            }
        }
        if let Some(place) = chosen {
            (*latitude, *longitude) = (place.latitude, place.longitude);
            // Keeps the clock time and takes the new place's time zone.
            *when = place.zone().nearest_moment(when.naive_local());
            self.text.clear();
        }
        ui.horizontal(|ui| {
            coordinate(ui, latitude, 90.0, Axis::Latitude);
            coordinate(ui, longitude, 180.0, Axis::Longitude);
        });
    }

    /// Sunrise, noon and sunset of the day, computed once per day.
    fn events(&mut self, when: DateTime<FixedOffset>, place: Place) -> Option<SunEvents> {
        let Place {
            latitude,
            longitude,
        } = place;
        let offset = *when.offset();
        let key = (
            when.date_naive(),
            offset.local_minus_utc(),
            [latitude, longitude].map(f64::to_bits),
        );
        if self.events.as_ref().is_none_or(|(of, _)| *of != key) {
            let found = sun_events(when.date_naive(), offset, latitude, longitude);
            self.events = found.ok().map(|events| (key, events));
        }
        self.events.as_ref().map(|(_, events)| *events)
    }
}

fn coordinate(ui: &mut Ui, degrees: &mut f64, limit: f64, axis: Axis) {
    let value = field(degrees)
        .range(-limit..=limit)
        .speed(0.1)
        .custom_formatter(move |degrees, _| axis.written(degrees))
        .custom_parser(move |text| axis.parse(text));
    ui.add(value);
}

/// Sliders for day of the year and year.
fn date(ui: &mut Ui, when: &mut DateTime<FixedOffset>, zone: Zone) {
    let local = when.naive_local();
    let (mut ordinal, mut year) = (local.ordinal(), local.year());
    let days = if local.date().leap_year() { 366 } else { 365 };
    let slider = slider(&mut ordinal, 1..=days)
        .show_value(false)
        .text(local.format("%e %B").to_string());
    let mut changed = ui.add(slider).changed();
    ui.horizontal(|ui| {
        changed |= ui.add(field(&mut year).range(YEARS)).changed();
        ui.weak(format!("year, UTC{}", when.offset()));
    });
    // Day 366 exists only in leap years; otherwise use day 365.
    let date = NaiveDate::from_yo_opt(year, ordinal).or(NaiveDate::from_yo_opt(year, 365));
    if changed && let Some(date) = date {
        set_local(when, date.and_time(local.time()), zone);
    }
}

/// Sets date and time. If the UTC offset is that of the place, it follows daylight saving time; otherwise it is kept.
fn set_local(when: &mut DateTime<FixedOffset>, local: NaiveDateTime, zone: Zone) {
    let offset = *when.offset();
    *when = if zone.has_offset_of(*when) {
        zone.nearest_moment(local)
    } else {
        Zone::Offset(offset).nearest_moment(local)
    };
}

/// The time-of-day slider, with marks at sunrise and sunset.
fn time_of_day(
    ui: &mut Ui,
    when: &mut DateTime<FixedOffset>,
    zone: Zone,
    events: Option<&SunEvents>,
) {
    let local = when.naive_local();
    let mut hours = f64::from(local.time().num_seconds_from_midnight()) / 3600.0;
    let slider = slider(&mut hours, 0.0..=23.99)
        .show_value(false)
        .text(local.format("%H:%M").to_string());
    let response = ui.add(slider);
    if response.changed() {
        let seconds = (hours * 3600.0) as u32;
        if let Some(time) = NaiveTime::from_num_seconds_from_midnight_opt(seconds.min(86_399), 0) {
            set_local(when, local.date().and_time(time), zone);
        }
    }
    let date = local.date();
    for event in events
        .into_iter()
        .flat_map(|e| [e.sunrise, e.sunset])
        .flatten()
        .filter(|e| e.date_naive() == date)
    {
        mark(ui, &response, event.num_seconds_from_midnight());
    }
}

/// Draws a tick below the slider's rail at a time of day.
fn mark(ui: &Ui, response: &Response, seconds: u32) {
    // The centre of the handle stays one radius away from both ends of the rail.
    let radius = response.rect.height() / 2.5;
    let width = ui.spacing().slider_width;
    let x = response.rect.left() + radius + (width - 2.0 * radius) * seconds as f32 / 86_400.0;
    let y = response.rect.bottom();
    let tip = pos2(x, y - 4.0);
    ui.painter().add(egui::Shape::convex_polygon(
        vec![tip, tip + vec2(-3.5, 6.0), tip + vec2(3.5, 6.0)],
        style::ACCENT,
        egui::Stroke::new(0.5, Color32::BLACK),
    ));
}

/// Buttons that start, stop and set the speed of the clock.
fn clock_buttons(ui: &mut Ui, clock: &mut Clock) {
    ui.horizontal(|ui| {
        let text = if clock.is_on() { "stop" } else { "play" };
        if ui.button(text).clicked() {
            clock.toggle();
        }
        for (speed, name) in SPEEDS {
            ui.selectable_value(&mut clock.speed, speed, name);
        }
    });
}

/// Sunrise, noon and sunset as text.
fn events_text(events: &SunEvents) -> String {
    let clock = |event: Option<DateTime<FixedOffset>>| {
        event.map_or("none".to_owned(), |e| e.format("%H:%M").to_string())
    };
    format!(
        "sunrise {}, noon {}, sunset {}",
        clock(events.sunrise),
        clock(events.noon),
        clock(events.sunset)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::moment::default_moment;

    fn names(text: &str) -> Vec<String> {
        suggestions(text)
            .into_iter()
            .map(|(name, _)| name)
            .collect()
    }

    #[test]
    fn a_field_suggests_cities_and_coordinates() {
        assert_eq!(names("  "), [""; 0]);
        assert_eq!(names("toky"), ["Tokyo, JP"]);
        assert_eq!(names("tokio"), ["Tokyo, JP"]);
        assert_eq!(names("-33.87 N, 151.21"), ["33.87° S, 151.21° E"]);
        assert_eq!(names("33.87"), [""; 0]);
        assert_eq!(names("a").len(), MAX_FOUND);
    }

    /// Place and time after typing `text` and Enter into the field.
    fn entered(text: &str) -> (String, String) {
        let context = egui::Context::default();
        let (mut field, mut place) = (PlaceField::default(), Place::default());
        let mut when = default_moment(place);
        let key = |key| egui::Event::Key {
            key,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers: egui::Modifiers::NONE,
        };
        // Tab moves the focus to the field.
        let typed = egui::Event::Text(text.to_owned());
        for event in [
            None,
            Some(key(Key::Tab)),
            Some(typed),
            Some(key(Key::Enter)),
        ] {
            let input = egui::RawInput {
                events: event.into_iter().collect(),
                ..egui::RawInput::default()
            };
            let output = context.run_ui(input, |ui| {
                field.show(ui, &mut place.latitude, &mut place.longitude, &mut when);
            });
            output.drop_without_applying_deltas();
        }
        (place.to_string(), when.to_rfc3339())
    }

    #[test]
    fn enter_takes_the_suggestion() {
        let tokyo = "35.68° N, 139.69° E".to_owned();
        let afternoon = "2026-06-21T15:00:00+09:00".to_owned();
        assert_eq!(entered("toky"), (tokyo, afternoon));
        assert_eq!(entered("-33.87 N, 151.21").0, "33.87° S, 151.21° E");
        assert_eq!(entered("").0, "55.79° N, 12.52° E");
    }

    #[test]
    fn sliders_keep_summer_time_and_a_clock_of_the_users_own() {
        let zone = Zone::parse("Europe/Copenhagen").expect("a zone");
        let winter = |when: &str| {
            let mut when = DateTime::parse_from_rfc3339(when).expect("a moment");
            let date = NaiveDate::from_ymd_opt(2026, 12, 21).expect("a date");
            let local = date.and_time(when.time());
            set_local(&mut when, local, zone);
            when.to_rfc3339()
        };
        assert_eq!(
            winter("2026-06-21T15:00:00+02:00"),
            "2026-12-21T15:00:00+01:00"
        );
        assert_eq!(
            winter("2026-06-21T15:00:00+05:00"),
            "2026-12-21T15:00:00+05:00"
        );
    }
}
