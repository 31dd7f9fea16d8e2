//! Boxes over the image.

use egui::{Align2, Ui};

use crate::commands::view::style;

/// A box anchored to a corner of the image, which takes the pointer.
pub(super) fn corner(
    ui: &Ui,
    id: &str,
    anchor: Align2,
    offset: [f32; 2],
    content: impl FnOnce(&mut Ui),
) -> egui::Response {
    shown(ui, area(id, anchor, offset), content)
}

/// The same of what is read alone: the pointer reaches the image through it. A read-out of what is under the pointer that took it
/// would come and go forever.
pub(super) fn read_out(
    ui: &Ui,
    id: &str,
    anchor: Align2,
    offset: [f32; 2],
    content: impl FnOnce(&mut Ui),
) -> egui::Response {
    shown(ui, area(id, anchor, offset).interactable(false), |ui| {
        ui.style_mut().interaction.selectable_labels = false;
        content(ui);
    })
}

fn area(id: &str, anchor: Align2, offset: [f32; 2]) -> egui::Area {
    egui::Area::new(egui::Id::new(id))
        .anchor(anchor, offset)
        .interactable(true)
}

fn shown(ui: &Ui, area: egui::Area, content: impl FnOnce(&mut Ui)) -> egui::Response {
    area.show(ui.ctx(), |ui| style::backdrop().show(ui, content))
        .response
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::view::interface::Interface;
    use egui::{Context, Event, Panel, Pos2, RawInput, Rect, Response, pos2, vec2};

    /// Whether a box counts as interface when the pointer is on it, in three layouts of a window of this many pixels a point.
    fn takes_pointer(scale: f32, show: impl Fn(&Ui) -> Response) -> [bool; 3] {
        let context = Context::default();
        let mut at = Pos2::ZERO;
        let mut lay_out = || {
            let size = vec2(960.0, 270.0) / scale;
            let mut input = RawInput {
                screen_rect: Some(Rect::from_min_size(Pos2::ZERO, size)),
                events: vec![Event::PointerMoved(at)],
                ..RawInput::default()
            };
            let root = input.viewports.entry(input.viewport_id).or_default();
            root.native_pixels_per_point = Some(scale);
            let output = context.run_ui(input, |ui| at = show(ui).rect.center());
            drop(output);
            context.is_pointer_over_egui()
        };
        // The first layouts find its size, and the pointer its place.
        for _ in 0..2 {
            lay_out();
        }
        [lay_out(), lay_out(), lay_out()]
    }

    #[test]
    fn a_finger_is_taken_by_what_is_at_its_place() {
        let (context, mut interface) = (Context::default(), Interface::new(true));
        let whole = Rect::from_min_size(Pos2::ZERO, vec2(400.0, 300.0));
        for _ in 0..3 {
            let input = RawInput {
                screen_rect: Some(whole),
                ..RawInput::default()
            };
            drop(context.run_ui(input, |ui| {
                Panel::left("panel").show(ui, |ui| ui.label("Sun"));
                corner(ui, "note", Align2::RIGHT_TOP, [-12.0, 12.0], |ui| {
                    ui.label("a note");
                });
                interface.show(ui, None);
            }));
        }
        let places = [(5.0, 150.0), (380.0, 25.0), (300.0, 200.0)];
        let taken = places.map(|(x, y)| interface.is_at(&context, pos2(x, y)));
        assert_eq!(taken, [true, true, false], "panel, note, picture");
    }

    #[test]
    fn the_pointer_reaches_the_picture_through_a_read_out_and_not_through_a_box() {
        let content = |ui: &mut Ui| {
            ui.label("luminance");
        };
        let anchor = Align2::RIGHT_BOTTOM;
        for scale in [1.0, 1.5, 2.0] {
            let read = |ui: &Ui| read_out(ui, "a", anchor, [-12.0; 2], content);
            assert_eq!(takes_pointer(scale, read), [false; 3], "{scale}");
            let box_of = |ui: &Ui| corner(ui, "a", anchor, [-12.0; 2], content);
            assert_eq!(takes_pointer(scale, box_of), [true; 3], "{scale}");
        }
    }
}
