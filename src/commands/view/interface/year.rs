//! The hours of a weather file: sliders over the days of the year and the hours of a day.

use egui::Ui;

use super::numbers::slider;
use crate::commands::view::year::Year;
use crate::commands::weather::MONTHS;
use crate::daylight::weather::Record;
use crate::options::Options;

/// Shows the sliders, or a way back to the hours of the file; whether they are shown.
pub(super) fn show(ui: &mut Ui, year: &mut Year, settings: &mut Options) -> bool {
    let Some(shown) = year.shown(settings) else {
        let hint = format!("place, sun and sky of {}", year.weather.station.name);
        let back = ui.button("back to the weather file");
        if back.on_hover_text(hint).clicked() {
            year.show(settings, year.last());
        }
        return false;
    };
    ui.label(&year.weather.station.name);
    let record = year.weather.records[shown];
    let mut day = year.day_of(shown);
    let of_day = shown - year.days()[day].start;
    let mut hour = of_day;
    let days = slider(&mut day, 0..=year.days().len() - 1)
        .show_value(false)
        .text(date(&record));
    let other_day = ui.add(days).changed();
    let hours = slider(&mut hour, 0..=year.days()[day].len() - 1)
        .show_value(false)
        .text(span(&record, year.weather.step_hours));
    let other_hour = ui.add(hours).changed();
    if other_day || other_hour {
        let records = year.days()[day].clone();
        year.show(settings, (records.start + hour).min(records.end - 1));
    }
    true
}

fn date(record: &Record) -> String {
    format!("{} {}", record.day, MONTHS[record.month as usize - 1])
}

/// First and last minute of a record, by the clock of the file.
fn span(record: &Record, step_hours: f64) -> String {
    let clock = |hour: f64| {
        let minutes = (hour * 60.0).round() as u32;
        format!("{:02}:{:02}", minutes / 60, minutes % 60)
    };
    let half = 0.5 * step_hours;
    format!(
        "{} to {}",
        clock(record.hour - half),
        clock(record.hour + half)
    )
}
