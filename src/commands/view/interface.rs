//! The user interface over the image: panel, read-outs, overlays, messages. It changes the document's settings; everything
//! else is requested from the event loop.

mod air;
mod clock;
mod help;
mod legend;
mod light;
mod notes;
mod numbers;
mod picture;
mod probe;
mod sky_dome;
mod status;
mod sun;
mod timings;

pub(super) use clock::shift;
pub(super) use notes::Notes;

use egui::{Align2, CollapsingHeader, FocusDirection, Panel, ScrollArea, Ui};
use glam::DVec3;

use crate::options::Choice;
use crate::output::print;
use crate::passes::light::probe::Reading;

use super::document::Document;
use super::keys::Action;
use super::stage::Stage;
use super::style;

use clock::Clock;
use probe::Probe;
use sky_dome::SkyDome;
use sun::PlaceField;
use timings::TimingChart;

/// A request to the event loop.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum UiRequest {
    /// Perform a key's action.
    Do(Action),
    /// Copy text to the clipboard.
    Copy(String),
}

/// What to do first in a new window.
const HINT: &str =
    "drag to orbit, right drag to look, W A S D to fly, H for a later hour, ? for all keys";

/// State of the user interface.
pub(super) struct Interface {
    is_visible: bool,
    /// Whether the keyboard is about to work the panel.
    is_entered: bool,
    help: bool,
    notes: Notes,
    clock: Clock,
    place: PlaceField,
    probe: Probe,
    sky_dome: SkyDome,
    timings: TimingChart,
    light: light::Readout,
}

impl Interface {
    /// Starts with the panel open and everything else closed. `quiet` suppresses notices.
    pub(super) fn new(quiet: bool) -> Self {
        Self {
            is_visible: true,
            is_entered: false,
            help: false,
            notes: Notes::new(quiet),
            clock: Clock::default(),
            place: PlaceField::default(),
            probe: Probe::default(),
            sky_dome: SkyDome::default(),
            timings: TimingChart::default(),
            light: light::Readout::default(),
        }
    }

    /// Whether the panels are shown.
    pub(super) fn is_visible(&self) -> bool {
        self.is_visible
    }

    /// Shows how to move, for a while.
    pub(super) fn hint(&mut self) {
        self.notes.hint(HINT);
    }

    /// Shows a notice for a few seconds.
    pub(super) fn say(&mut self, text: &str) {
        self.notes.say(text);
    }

    /// Shows a warning for a few seconds, also with `--quiet`.
    pub(super) fn warn(&mut self, text: &str) {
        self.notes.warn(text);
    }

    /// Shows an error until the user dismisses it.
    pub(super) fn complain(&mut self, text: &str) {
        self.notes.complain(text);
    }

    /// Sets the loading progress (0..1) and stage; `None` when nothing is loading.
    pub(super) fn loading(&mut self, progress: Option<(f32, &'static str)>) {
        self.notes.loading = progress;
    }

    /// Advances the time of day by `seconds` of real time.
    pub(super) fn play(&mut self, document: &mut Document, seconds: f64) {
        self.clock.advance(&mut document.job.settings.sun, seconds);
    }

    /// Whether the time of day is advancing.
    pub(super) fn is_playing(&self, document: &Document) -> bool {
        self.clock.is_running(&document.job.settings.sun)
    }

    /// Whether the read-out belongs to this pixel of the current image.
    pub(super) fn is_probed(&self, pixel: Option<[u32; 2]>, document: Option<&Document>) -> bool {
        self.probe.is_fresh(pixel, document)
    }

    /// Sets the read-out of a pixel.
    pub(super) fn probed(
        &mut self,
        pixel: Option<[u32; 2]>,
        reading: Option<Reading>,
        document: Option<&Document>,
    ) {
        self.probe.set(pixel, reading, document);
    }

    /// The scene point under the pointer, metres.
    pub(super) fn point_under_pointer(&self) -> Option<DVec3> {
        self.probe.point()
    }

    /// Toggles the chart of pass times; returns whether it is open.
    pub(super) fn toggle_timings(&mut self) -> bool {
        self.timings.is_open = !self.timings.is_open;
        self.timings.is_open
    }

    /// Whether the chart of pass times is open.
    pub(super) fn is_timed(&self) -> bool {
        self.timings.is_open
    }

    /// Updates the pass times and the device memory use.
    pub(super) fn observe(&mut self, stage: &Stage) {
        self.timings.observe(stage);
    }

    /// Performs a key's action; returns requests to the event loop.
    pub(super) fn perform(&mut self, action: Action, document: &mut Document) -> Vec<UiRequest> {
        let mut requests = Vec::new();
        match action {
            Action::ToggleInterface => self.is_visible = !self.is_visible,
            Action::Panel => {
                self.is_visible = true;
                self.is_entered = true;
            }
            Action::Help => self.help = !self.help,
            Action::Dismiss => {
                self.help = false;
                self.notes.dismiss();
            }
            Action::Play => self.clock.toggle(),
            Action::ToggleSunPath => self.sky_dome.toggle(),
            Action::CopyCommand => {
                let command = document.command();
                let printed = command.and_then(|line| print(&format!("{line}\n")).map(|()| line));
                match printed {
                    Ok(line) => {
                        self.say("copied the command that renders this picture");
                        requests.push(UiRequest::Copy(line));
                    }
                    Err(error) => self.complain(&error.to_string()),
                }
            }
            other => document.perform(other, &mut self.notes),
        }
        requests
    }

    /// Lays out the user interface; returns requests to the event loop.
    pub(super) fn show(&mut self, ui: &mut Ui, document: Option<&mut Document>) -> Vec<UiRequest> {
        let mut requests = Vec::new();
        if std::mem::take(&mut self.is_entered) {
            // The first field that is laid out takes it.
            ui.memory_mut(|memory| memory.move_focus(FocusDirection::Next));
        }
        if self.is_visible {
            if let Some(document) = document {
                self.sky_dome.show(ui, document);
                self.panel(ui, document, &mut requests);
                self.probe.show(ui, document);
                self.timings.show(ui, document);
                legend::show(ui, &document.job.settings);
            }
            help::show(ui, &mut self.help);
        }
        self.notes.show(ui, self.is_visible);
        requests
    }

    fn panel(&mut self, ui: &mut Ui, document: &mut Document, requests: &mut Vec<UiRequest>) {
        let frame = style::backdrop().corner_radius(0);
        Panel::left("panel")
            .frame(frame)
            .default_size(290.0)
            .size_range(250.0..=420.0)
            .show_separator_line(false)
            .show(ui, |ui| {
                status::header(ui, document, requests);
                ScrollArea::vertical().show(ui, |ui| self.sections(ui, document, requests));
            });
    }

    fn sections(&mut self, ui: &mut Ui, document: &mut Document, requests: &mut Vec<UiRequest>) {
        section(ui, "Sun", true, |ui| {
            sun::show(ui, document, &mut self.place, &mut self.clock);
            self.sky_dome.switches(ui);
        });
        section(ui, "Air and ground", true, |ui| air::show(ui, document));
        section(ui, "Picture", true, |ui| {
            picture::show(ui, document, requests);
        });
        section(ui, "Light", false, |ui| {
            self.light.show(ui, document);
        });
        section(ui, "View", false, |ui| {
            status::view(ui, document);
        });
        section(ui, "Scene", false, |ui| {
            status::scene(ui, document, requests, &self.timings);
        });
    }
}

/// A collapsible section of the panel.
fn section(ui: &mut Ui, title: &str, open: bool, content: impl FnOnce(&mut Ui)) {
    let heading = egui::RichText::new(title).heading();
    CollapsingHeader::new(heading)
        .id_salt(title)
        .default_open(open)
        .show_unindented(ui, |ui| {
            content(ui);
            ui.add_space(6.0);
        });
}

/// A labelled row with a drop-down of an option's values, named as on the command line. Returns whether the value changed.
fn choice<T: Choice>(ui: &mut Ui, label: &str, value: &mut T) -> bool {
    let mut changed = false;
    egui::ComboBox::new(label, label)
        .selected_text(value.option_name())
        .show_ui(ui, |ui| {
            for (variant, name, help) in T::VALUES {
                let line = ui.selectable_value(value, *variant, *name);
                changed |= line.on_hover_text(*help).changed();
            }
        });
    changed
}

/// A box anchored to a corner of the image, which takes the pointer.
fn corner(
    ui: &Ui,
    id: &str,
    anchor: Align2,
    offset: [f32; 2],
    content: impl FnOnce(&mut Ui),
) -> egui::Response {
    egui::Area::new(egui::Id::new(id))
        .anchor(anchor, offset)
        .interactable(true)
        .show(ui.ctx(), |ui| style::backdrop().show(ui, content))
        .response
}

/// The same of what is read alone: the pointer reaches the image through it. A read-out of what is under the pointer that took it
/// would come and go forever.
fn read_out(
    ui: &Ui,
    id: &str,
    anchor: Align2,
    offset: [f32; 2],
    content: impl FnOnce(&mut Ui),
) -> egui::Response {
    egui::Area::new(egui::Id::new(id))
        .anchor(anchor, offset)
        .interactable(false)
        .show(ui.ctx(), |ui| {
            ui.style_mut().interaction.selectable_labels = false;
            style::backdrop().show(ui, content)
        })
        .response
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{Context, Event, Pos2, RawInput, Rect, Response, vec2};

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
        (lay_out(), lay_out());
        [lay_out(), lay_out(), lay_out()]
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
