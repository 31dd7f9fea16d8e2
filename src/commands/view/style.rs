//! Style of the user interface: dark and slightly translucent.

use egui::{Color32, CornerRadius, FontId, Frame, Margin, Stroke, TextStyle};

/// Background of panels. Blending is in linear light, where even slight transparency is conspicuous.
const BACKDROP: Color32 = Color32::from_rgba_premultiplied(13, 15, 19, 246);
/// Colour of text, and of secondary text.
const TEXT: Color32 = Color32::from_gray(222);
const WEAK: Color32 = Color32::from_gray(168);
/// Colour of selected and highlighted items.
pub(super) const ACCENT: Color32 = Color32::from_rgb(255, 196, 87);
/// Colour of errors.
pub(super) const ALARM: Color32 = Color32::from_rgb(255, 120, 100);

/// Sets fonts, colours and spacing.
pub(super) fn apply(context: &egui::Context) {
    context.set_theme(egui::Theme::Dark);
    context.all_styles_mut(|style| {
        style.spacing.slider_width = 150.0;
        style.spacing.item_spacing = egui::vec2(6.0, 5.0);
        style.visuals.override_text_color = Some(TEXT);
        style.visuals.weak_text_color = Some(WEAK);
        style.visuals.panel_fill = BACKDROP;
        style.visuals.window_fill = BACKDROP;
        style.visuals.window_stroke = Stroke::new(1.0, Color32::from_white_alpha(18));
        style.visuals.selection.bg_fill = Color32::from_rgb(122, 86, 22);
        style.visuals.selection.stroke = Stroke::new(1.0, ACCENT);
        style.visuals.slider_trailing_fill = true;
        style
            .text_styles
            .insert(TextStyle::Heading, FontId::proportional(15.0));
    });
}

/// Frame style of a box over the image.
pub(super) fn backdrop() -> Frame {
    Frame::new()
        .fill(BACKDROP)
        .corner_radius(CornerRadius::same(5))
        .inner_margin(Margin::symmetric(10, 8))
}
