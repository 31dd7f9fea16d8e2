//! Position of the sun: by place and time, by solar time, or as a direction.

use chrono::{
    DateTime, Datelike, FixedOffset, NaiveDate, NaiveDateTime, NaiveTime, TimeDelta, Timelike,
};
use egui::{Color32, DragValue, Response, Slider, TextEdit, Ui, pos2, vec2};

use super::clock::{Clock, SPEEDS};
use crate::commands::view::document::Document;
use crate::commands::view::style;
use crate::daylight::cities;
use crate::daylight::sun_position::{SunEvents, SunPosition, sun_events};
use crate::settings::{Settings, SunInput};

/// Most cities that a search lists.
const MOST_FOUND: usize = 8;
/// Distance within which a city names the place, km.
const NEAR_KM: f64 = 30.0;

/// The search for a place.
#[derive(Debug, Default)]
pub(super) struct Place {
    text: String,
    /// Sunrise, noon and sunset, cached by day.
    events: Option<(Day, SunEvents)>,
}

/// A calendar day somewhere: date, UTC offset (s), latitude and longitude (bits).
type Day = (NaiveDate, i32, [u64; 2]);

pub(super) fn show(ui: &mut Ui, document: &mut Document, place: &mut Place, clock: &mut Clock) {
    let sun = document.job.sun;
    let settings = &mut document.job.settings;
    kind(ui, settings, &sun);
    match &mut settings.sun {
        SunInput::Place {
            latitude,
            longitude,
            when,
        } => {
            place.search(ui, latitude, longitude, when);
            date(ui, when);
            let events = place.events(*when, *latitude, *longitude);
            day(ui, when, events.as_ref());
            playback(ui, clock);
            if let Some(events) = &events {
                ui.weak(events_text(events));
            }
        }
        SunInput::Solar {
            day,
            hours,
            latitude,
        } => {
            ui.add(
                Slider::new(latitude, -90.0..=90.0)
                    .suffix("°")
                    .text("latitude"),
            );
            ui.add(Slider::new(day, 1..=365).text("day of the year"));
            ui.add(Slider::new(hours, 0.0..=24.0).text("solar time, h"));
            playback(ui, clock);
        }
        SunInput::Direction {
            azimuth_deg,
            elevation_deg,
        } => {
            ui.add(
                Slider::new(azimuth_deg, 0.0..=360.0)
                    .suffix("°")
                    .text("azimuth"),
            );
            ui.add(
                Slider::new(elevation_deg, -20.0..=90.0)
                    .suffix("°")
                    .text("elevation"),
            );
        }
    }
    ui.label(format!(
        "azimuth {:.1}°, elevation {:.1}°",
        sun.azimuth_deg, sun.apparent_elevation_deg
    ));
}

/// Switches between the three ways to set the sun, keeping as much as possible.
fn kind(ui: &mut Ui, settings: &mut Settings, sun: &SunPosition) {
    let now = std::mem::discriminant(&settings.sun);
    let place = SunInput::Place {
        latitude: 55.79,
        longitude: 12.52,
        when: default_moment(),
    };
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

fn default_moment() -> DateTime<FixedOffset> {
    let date = NaiveDate::from_ymd_opt(2026, 6, 21).unwrap_or_default();
    moment_at(date, 15.0 * 3600.0, FixedOffset::east_opt(7200))
}

fn moment_at(date: NaiveDate, seconds: f64, offset: Option<FixedOffset>) -> DateTime<FixedOffset> {
    let offset = offset.unwrap_or(FixedOffset::east_opt(0).unwrap_or_else(|| unreachable!("UTC")));
    let local = date.and_time(NaiveTime::MIN) + TimeDelta::milliseconds((seconds * 1e3) as i64);
    DateTime::from_naive_utc_and_offset(local - offset, offset)
}

/// The same day, time and latitude in solar time.
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

impl Place {
    fn search(
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
        ui.add(TextEdit::singleline(&mut self.text).hint_text(hint));
        if !self.text.trim().is_empty() {
            for city in cities::search(&self.text).into_iter().take(MOST_FOUND) {
                let name = format!("{}, {}", city.name, city.country);
                if ui.selectable_label(false, name).clicked() {
                    (*latitude, *longitude) = (city.latitude, city.longitude);
                    // The local time stays: 15:00 there.
                    *when = city.moment(when.naive_local());
                    self.text.clear();
                    break;
                }
            }
        }
        ui.horizontal(|ui| {
            coordinate(ui, latitude, 90.0, "° N");
            coordinate(ui, longitude, 180.0, "° E");
        });
    }

    /// Sunrise, noon and sunset of the day.
    fn events(
        &mut self,
        when: DateTime<FixedOffset>,
        latitude: f64,
        longitude: f64,
    ) -> Option<SunEvents> {
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

fn coordinate(ui: &mut Ui, degrees: &mut f64, most: f64, suffix: &str) {
    let value = DragValue::new(degrees)
        .range(-most..=most)
        .speed(0.1)
        .max_decimals(3)
        .suffix(suffix);
    ui.add(value);
}

/// The day of the year on a slider, and the year.
fn date(ui: &mut Ui, when: &mut DateTime<FixedOffset>) {
    let local = when.naive_local();
    let (mut ordinal, mut year) = (local.ordinal(), local.year());
    let slider = Slider::new(&mut ordinal, 1..=365)
        .show_value(false)
        .text(local.format("%e %B").to_string());
    let mut changed = ui.add(slider).changed();
    ui.horizontal(|ui| {
        changed |= ui.add(DragValue::new(&mut year).range(1..=3000)).changed();
        ui.weak(format!("year, UTC{}", when.offset()));
    });
    if changed && let Some(date) = NaiveDate::from_yo_opt(year, ordinal) {
        set_local(when, date.and_time(local.time()));
    }
}

fn set_local(when: &mut DateTime<FixedOffset>, local: NaiveDateTime) {
    let offset = *when.offset();
    *when = DateTime::from_naive_utc_and_offset(local - offset, offset);
}

/// The time of day on a slider with marks of sunrise and sunset.
fn day(ui: &mut Ui, when: &mut DateTime<FixedOffset>, events: Option<&SunEvents>) {
    let local = when.naive_local();
    let mut hours = f64::from(local.time().num_seconds_from_midnight()) / 3600.0;
    let slider = Slider::new(&mut hours, 0.0..=23.99)
        .show_value(false)
        .text(local.format("%H:%M").to_string());
    let response = ui.add(slider);
    let rail = response.rect;
    if response.changed() {
        let seconds = (hours * 3600.0) as u32;
        if let Some(time) = NaiveTime::from_num_seconds_from_midnight_opt(seconds.min(86_399), 0) {
            set_local(when, local.date().and_time(time));
        }
    }
    let date = local.date();
    for event in events
        .into_iter()
        .flat_map(|e| [e.sunrise, e.sunset])
        .flatten()
        .filter(|e| e.date_naive() == date)
    {
        mark(
            ui,
            rail.left(),
            &response,
            event.num_seconds_from_midnight(),
        );
    }
}

/// A tick under the slider's rail at a time of the day.
fn mark(ui: &Ui, left: f32, response: &Response, seconds: u32) {
    // The handle moves within the rail less its own radius at each end.
    let radius = response.rect.height() / 2.5;
    let width = ui.spacing().slider_width;
    let x = left + radius + (width - 2.0 * radius) * seconds as f32 / 86_400.0;
    let y = response.rect.bottom();
    let tip = pos2(x, y - 4.0);
    ui.painter().add(egui::Shape::convex_polygon(
        vec![tip, tip + vec2(-3.5, 6.0), tip + vec2(3.5, 6.0)],
        style::ACCENT,
        egui::Stroke::new(0.5, Color32::BLACK),
    ));
}

/// The play button and the speeds.
fn playback(ui: &mut Ui, clock: &mut Clock) {
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
