//! Image settings: displayed quantity, false colours, tone curve, exposure.

use std::ops::RangeInclusive;

use egui::{ComboBox, Ui};

use super::numbers::{field, slider};
use super::{UiRequest, choice};
use crate::commands::view::document::Document;
use crate::commands::view::keys::Action;
use crate::daylight::hdr::PQ_PEAK;
use crate::daylight::sun_hours::{SunDate, SunDates};
use crate::options::{Choice, Options, Quantity, Range, Show};

/// Range of the exposure slider, EV100: from starlight to sunlit snow.
const EV100_RANGE: RangeInclusive<f64> = -14.0..=18.0;
/// Exposure when automatic exposure is turned off, EV100: a sunny day.
const SUNNY_EV100: f64 = 14.0;
/// Lowest automatic exposure when one is asked for, EV100: a landscape under the full moon is dark.
const MOONLIT_EV100: f64 = -2.0;

pub(super) fn show(ui: &mut Ui, document: &mut Document, requests: &mut Vec<UiRequest>) {
    let screen = document.screen();
    let settings = &mut document.job.settings;
    if choice(ui, "show", &mut settings.show) {
        settings.show_in_colours();
    }
    false_colours(ui, settings);
    if settings.show == Show::SunHours {
        sun_hours(ui, settings);
    }
    choice(ui, "edges in motion", &mut settings.aa);
    ui.add_enabled_ui(!screen.is_hdr, |ui| {
        choice(ui, "tone curve", &mut settings.tonemap)
    })
    .response
    .on_disabled_hover_text("an HDR screen shows cd/m² in proportion");
    if screen.offers_hdr {
        choice(ui, "HDR", &mut settings.hdr);
        if screen.is_hdr {
            let peak = slider(&mut settings.hdr_peak, 100.0..=PQ_PEAK);
            ui.add(peak.logarithmic(true).text("peak, cd/m²"))
                .on_hover_text("peak luminance of the screen; white paper has 203 cd/m²");
        }
    }
    exposure(ui, &mut settings.ev100, &mut settings.min_ev100);
    ui.horizontal(|ui| {
        for (text, action) in [
            ("screenshot", Action::Screenshot),
            ("copy command", Action::CopyCommand),
        ] {
            if ui.button(text).clicked() {
                requests.push(UiRequest::Do(action));
            }
        }
    });
}

/// False-colour selection: off, or a quantity and a range.
fn false_colours(ui: &mut Ui, settings: &mut Options) {
    let before = settings.false_colour;
    let name = |q: Option<Quantity>| q.map_or("off", crate::options::name);
    ComboBox::new("false colours", "false colours")
        .selected_text(name(before))
        .show_ui(ui, |ui| {
            let each = Quantity::VALUES.iter().map(|q| Some(q.0));
            for quantity in std::iter::once(None).chain(each) {
                ui.selectable_value(&mut settings.false_colour, quantity, name(quantity));
            }
        });
    if settings.false_colour != before {
        settings.false_colour_range = None;
        // Each kind of false colour implies the displayed quantity.
        settings.show = match settings.false_colour {
            Some(Quantity::Illuminance) => Show::Irradiance,
            Some(Quantity::SunHours) => Show::SunHours,
            _ => Show::Beauty,
        };
    }
    if let Some(quantity) = settings.false_colour {
        choice(ui, "colours", &mut settings.colour_map);
        range(ui, &mut settings.false_colour_range, quantity);
    }
}

/// A date of which the hours of sun are shown, and the step.
fn sun_hours(ui: &mut Ui, settings: &mut Options) {
    let mut of_year = settings.sun_dates.0 == [SunDate::Year];
    ui.horizontal(|ui| {
        let (month, day) = match settings.sun_dates.0.first() {
            Some(SunDate::Day(_, month, day)) => (*month, *day),
            _ => (3, 21),
        };
        let (mut new_month, mut new_day) = (month, day);
        ui.add_enabled(!of_year, field(&mut new_day).range(1..=31));
        ui.add_enabled(
            !of_year,
            field(&mut new_month).range(1..=12).prefix("month "),
        );
        let changed = ui.checkbox(&mut of_year, "whole year").changed();
        // The last of a month follows the month.
        let date = format!(
            "{new_month}-{}",
            new_day.min(LONGEST[new_month as usize - 1])
        );
        if of_year && changed {
            settings.sun_dates = SunDates(vec![SunDate::Year]);
        } else if !of_year && (changed || (new_month, new_day) != (month, day)) {
            settings.sun_dates = SunDates(date.parse().into_iter().collect());
        }
    });
    ComboBox::new("sun step", "minutes from sun to sun")
        .selected_text(settings.sun_step.to_string())
        .show_ui(ui, |ui| {
            for minutes in [1, 5, 10, 15, 30, 60] {
                ui.selectable_value(&mut settings.sun_step, minutes, minutes.to_string());
            }
        });
}

/// Days of each month, without leap days.
const LONGEST: [u32; 12] = [31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];

/// Edits the ends of a range as powers of ten.
fn range(ui: &mut Ui, range: &mut Option<Range>, quantity: Quantity) {
    if quantity == Quantity::SunHours {
        return;
    }
    let shown = range.unwrap_or(quantity.daytime());
    let (mut min, mut max) = (shown.min.log10(), shown.max.log10());
    ui.horizontal(|ui| {
        let low = power(ui, &mut min, -3.0..=max - 0.5);
        let high = power(ui, &mut max, min + 0.5..=7.0);
        ui.label(quantity.unit());
        if low || high {
            *range = Some(Range {
                min: 10f64.powf(min),
                max: 10f64.powf(max),
            });
        }
    });
}

/// Edits a value as a power of ten; returns whether it changed.
fn power(ui: &mut Ui, value: &mut f64, range: RangeInclusive<f64>) -> bool {
    let power = field(value).speed(0.05).prefix("10^").max_decimals(1);
    ui.add(power.range(range)).changed()
}

fn exposure(ui: &mut Ui, ev100: &mut Option<f64>, min_ev100: &mut Option<f64>) {
    let mut auto = ev100.is_none();
    if ui.checkbox(&mut auto, "automatic exposure").changed() {
        *ev100 = (!auto).then_some(SUNNY_EV100);
    }
    let slider = |value| slider(value, EV100_RANGE).text("EV100");
    if let Some(ev100) = ev100 {
        ui.add(slider(ev100));
        return;
    }
    let mut is_limited = min_ev100.is_some();
    let hint = "the automatic exposure goes no lower than this exposure value";
    let limit = ui.checkbox(&mut is_limited, "leave the night dark");
    if limit.on_hover_text(hint).changed() {
        *min_ev100 = is_limited.then_some(MOONLIT_EV100);
    }
    if let Some(least) = min_ev100 {
        ui.add(slider(least));
    }
}
