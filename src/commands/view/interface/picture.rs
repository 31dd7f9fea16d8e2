//! The quantity shown, false colours, tone curve, exposure.

use std::ops::RangeInclusive;

use clap::ValueEnum;
use egui::{ComboBox, DragValue, Slider, Ui};

use super::{UiRequest, choice};
use crate::commands::view::document::Document;
use crate::commands::view::keys::Action;
use crate::settings::{Exposure, Quantity, Range, Settings, Show};

/// Range of the exposure slider: dusk to snow in the sun.
const EV100_RANGE: RangeInclusive<f64> = -4.0..=18.0;
/// Initial exposure of the slider when automatic exposure is turned off: a sunny day.
const SUNNY_EV100: f64 = 14.0;

pub(super) fn show(ui: &mut Ui, document: &mut Document, requests: &mut Vec<UiRequest>) {
    let settings = &mut document.job.settings;
    choice(ui, "show", &mut settings.show);
    false_colours(ui, settings);
    choice(ui, "tone curve", &mut settings.tone_curve);
    exposure(ui, &mut settings.exposure);
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

/// False colours: off, or of a quantity over a range.
fn false_colours(ui: &mut Ui, settings: &mut Settings) {
    let before = settings.false_colour;
    let name = |q: Option<Quantity>| q.map_or("off".to_owned(), crate::settings::name);
    ComboBox::new("false colours", "false colours")
        .selected_text(name(before))
        .show_ui(ui, |ui| {
            let each = Quantity::value_variants().iter().map(|q| Some(*q));
            for quantity in std::iter::once(None).chain(each) {
                ui.selectable_value(&mut settings.false_colour, quantity, name(quantity));
            }
        });
    if settings.false_colour != before {
        settings.false_colour_range = None;
        // Each colours one quantity.
        settings.show = match settings.false_colour {
            Some(Quantity::Illuminance) => Show::Irradiance,
            _ => Show::Beauty,
        };
    }
    if let Some(quantity) = settings.false_colour {
        range(ui, &mut settings.false_colour_range, quantity);
    }
}

/// The ends of a range as powers of ten.
fn range(ui: &mut Ui, range: &mut Option<Range>, quantity: Quantity) {
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

/// An editable power of ten; returns whether it changed.
fn power(ui: &mut Ui, value: &mut f64, range: RangeInclusive<f64>) -> bool {
    let power = DragValue::new(value)
        .speed(0.05)
        .prefix("10^")
        .max_decimals(1);
    ui.add(power.range(range)).changed()
}

fn exposure(ui: &mut Ui, exposure: &mut Exposure) {
    let mut auto = *exposure == Exposure::Auto;
    if ui.checkbox(&mut auto, "automatic exposure").changed() {
        *exposure = if auto {
            Exposure::Auto
        } else {
            Exposure::Ev100(SUNNY_EV100)
        };
    }
    if let Exposure::Ev100(ev100) = exposure {
        ui.add(Slider::new(ev100, EV100_RANGE).text("EV100"));
    }
}
