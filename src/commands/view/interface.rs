//! The user interface over the image: panel, read-outs, overlays, messages. It changes the document's settings; everything
//! else is requested from the event loop.

mod air;
mod boxes;
mod clock;
mod desk;
mod heat;
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
mod surfaces;
mod timings;
mod year;

pub(super) use clock::shift;
pub(super) use notes::Notes;

use egui::{CollapsingHeader, Context, FocusDirection, Order, Panel, Pos2, Rect, ScrollArea, Ui};
use glam::DVec3;

use crate::options::Choice;
use crate::output::print;
use crate::passes::light::probe::Reading;

use super::document::Document;
use super::keys::Action;
use super::stage::Stage;
use super::style;

use boxes::{corner, read_out};
use clock::Clock;
use heat::HeatMap;
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
    heat: HeatMap,
    timings: TimingChart,
    light: light::Readout,
    /// What the panel leaves of the window, points.
    free: Rect,
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
            heat: HeatMap::default(),
            timings: TimingChart::default(),
            light: light::Readout::default(),
            free: Rect::EVERYTHING,
        }
    }

    /// Whether panel or boxes are at a place of the window, points, and take a finger that goes down there. egui tells it of the
    /// pointer alone, and knows of a finger no sooner than at the next layout.
    pub(super) fn is_at(&self, context: &Context, place: Pos2) -> bool {
        let layer = context.layer_id_at(place);
        layer.is_some_and(|layer| layer.order != Order::Background) || !self.free.contains(place)
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
        if self.is_playing(document) {
            document.pass_time(seconds * self.clock.speed);
        }
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
                legend::show(ui, &document.job);
                desk::legend(ui, document);
                self.heat.show(ui, document, &self.probe);
            }
            help::show(ui, &mut self.help);
        }
        self.notes.show(ui, self.is_visible);
        self.free = ui.available_rect_before_wrap();
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
        if document.desk.is_some() {
            section(ui, "Sensors", true, |ui| desk::show(ui, document));
        }
        section(ui, "Air and ground", true, |ui| air::show(ui, document));
        section(ui, "Picture", true, |ui| {
            picture::show(ui, document, requests);
        });
        section(ui, "Surfaces", false, |ui| surfaces::show(ui, document));
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
