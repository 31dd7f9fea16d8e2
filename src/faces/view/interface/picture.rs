//! What is shown, and how it is exposed.

use egui::{Slider, Ui};

use super::{Wish, choice};
use crate::faces::view::document::Document;
use crate::faces::view::keys::Action;
use crate::settings::Exposure;

/// Exposure values on the slider: dusk to snow in the sun.
const EV100_RANGE: std::ops::RangeInclusive<f64> = -4.0..=18.0;
/// Where the slider starts when the exposure stops to be automatic: a sunny day.
const SUNNY_EV100: f64 = 14.0;

pub(super) fn show(ui: &mut Ui, document: &mut Document, wishes: &mut Vec<Wish>) {
    let settings = &mut document.job.settings;
    choice(ui, "show", &mut settings.show);
    choice(ui, "tone curve", &mut settings.tone_curve);
    exposure(ui, &mut settings.exposure);
    ui.horizontal(|ui| {
        for (text, action) in [
            ("screenshot", Action::Screenshot),
            ("copy command", Action::CopyCommand),
        ] {
            if ui.button(text).clicked() {
                wishes.push(Wish::Do(action));
            }
        }
    });
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
