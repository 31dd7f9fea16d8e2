//! Reflectance of each material, and transmittance of glass.

use egui::Ui;

use super::numbers::slider;
use crate::commands::view::document::Document;
use crate::commands::view::surfaces::MOST;

/// Most materials that have sliders.
const MOST_LISTED: usize = 60;

pub(super) fn show(ui: &mut Ui, document: &mut Document) {
    let surfaces = &mut document.surfaces;
    let mut changed = Vec::new();
    for (number, (name, is_glass, value)) in surfaces.list().enumerate().take(MOST_LISTED) {
        let name = if name.is_empty() { "unnamed" } else { name };
        let mut new = value;
        let slider = slider(&mut new, 0.0..=MOST).max_decimals(2).text(name);
        let hint = if is_glass {
            "transmittance of the glass, at normal incidence"
        } else {
            "diffuse reflectance; where there is a texture, a factor on it"
        };
        if ui.add(slider).on_hover_text(hint).changed() && new != value {
            changed.push((number, new));
        }
    }
    let more = surfaces.list().count().saturating_sub(MOST_LISTED);
    if more > 0 {
        ui.weak(format!("and {more} more materials"));
    }
    for (number, value) in changed {
        surfaces.set(number, Some(value));
    }
    if ui.button("those of the model").clicked() {
        surfaces.reset();
    }
}
