//! Reflectance of each material, and transmittance of glass.

use egui::Ui;

use super::numbers::slider;
use crate::commands::view::document::Document;
use crate::daylight::glass::clearest;

/// Most materials that have sliders.
const MOST_LISTED: usize = 60;

pub(super) fn show(ui: &mut Ui, document: &mut Document) {
    let (surfaces, settings) = (&document.surfaces, &mut document.job.settings);
    let list = surfaces.list(settings);
    for mut surface in list.iter().take(MOST_LISTED).cloned() {
        let (range, hint) = if surface.is_glass {
            let range = 0.01..=(clearest() * 100.0).floor() / 100.0;
            (range, "transmittance of the glass, at normal incidence")
        } else {
            (
                0.0..=1.0,
                "reflectance of a grey and matt surface in its place",
            )
        };
        let before = surface.value;
        let slider = slider(&mut surface.value, range)
            .max_decimals(2)
            .text(&surface.name);
        let hundredths = |value: f64| (value * 100.0).round();
        // A slider rounds what it is given, which is no change.
        let is_changed = ui.add(slider).on_hover_text(hint).changed();
        if is_changed && hundredths(surface.value) != hundredths(before) {
            surface.value = hundredths(surface.value) / 100.0;
            surfaces.set(settings, &surface);
        }
    }
    let more = list.len().saturating_sub(MOST_LISTED);
    if more > 0 {
        ui.weak(format!("and {more} more materials"));
    }
    if ui.button("those of the model").clicked() {
        (settings.glass, settings.reflectance) = (None, None);
    }
}
