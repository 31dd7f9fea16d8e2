//! The help overlay: keys and mouse gestures.

use egui::{Align2, Grid, RichText, Ui, Window};

use crate::commands::view::keys::BINDINGS;
use crate::commands::view::style;

pub(super) fn show(ui: &Ui, open: &mut bool) {
    Window::new("Keys and mouse")
        .open(open)
        .anchor(Align2::CENTER_CENTER, [0.0, 0.0])
        .collapsible(false)
        .resizable(false)
        .show(ui.ctx(), |ui| {
            Grid::new("keys").spacing([18.0, 4.0]).show(ui, |ui| {
                for binding in BINDINGS {
                    ui.label(RichText::new(binding.keys).color(style::ACCENT).strong());
                    ui.label(binding.what);
                    ui.end_row();
                }
            });
        });
}
