//! What lies over the picture: the panel, read-outs, overlays, messages. It changes the settings of the document and asks the
//! event loop for the rest.

mod air;
mod clock;
mod help;
mod legend;
mod light;
mod notes;
mod picture;
mod probe;
mod sky_dome;
mod status;
mod sun;
mod timings;

pub(super) use clock::shift;
pub(super) use notes::Notes;

use egui::{Align2, CollapsingHeader, Panel, ScrollArea, Ui};
use glam::DVec3;

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

/// What the user wants that the interface cannot do itself.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Wish {
    /// As a key would.
    Do(Action),
    /// Text on the clipboard.
    Copy(String),
}

/// The state of everything over the picture.
pub(super) struct Interface {
    is_visible: bool,
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
    /// With everything shut; `quiet` keeps warnings out of the window.
    pub(super) fn new(quiet: bool) -> Self {
        Self {
            is_visible: true,
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

    /// Whether there is anything but the picture.
    pub(super) fn is_visible(&self) -> bool {
        self.is_visible
    }

    /// Tells something for a while.
    pub(super) fn say(&mut self, text: &str) {
        self.notes.say(text);
    }

    /// Tells of a failure until it is dismissed.
    pub(super) fn complain(&mut self, text: &str) {
        self.notes.complain(text);
    }

    /// How far a load is, 0..1, and what it does; none when there is none.
    pub(super) fn loading(&mut self, progress: Option<(f32, &'static str)>) {
        self.notes.loading = progress;
    }

    /// Lets the day pass by `seconds` of the user's time.
    pub(super) fn play(&mut self, document: &mut Document, seconds: f64) {
        self.clock.advance(&mut document.job.settings.sun, seconds);
    }

    /// Whether the day passes.
    pub(super) fn is_playing(&self, document: &Document) -> bool {
        self.clock.is_running(&document.job.settings.sun)
    }

    /// Whether what is known of the pixel is what the picture shows.
    pub(super) fn is_probed(&self, pixel: Option<[u32; 2]>, document: Option<&Document>) -> bool {
        self.probe.is_fresh(pixel, document)
    }

    /// Takes over what a pixel shows.
    pub(super) fn probed(
        &mut self,
        pixel: Option<[u32; 2]>,
        reading: Option<Reading>,
        document: Option<&Document>,
    ) {
        self.probe.set(pixel, reading, document);
    }

    /// The point of the scene under the pointer, metres.
    pub(super) fn point_under_pointer(&self) -> Option<DVec3> {
        self.probe.point()
    }

    /// Opens the chart of times, or shuts it; returns which.
    pub(super) fn toggle_timings(&mut self) -> bool {
        self.timings.is_open = !self.timings.is_open;
        self.timings.is_open
    }

    /// Looks at what the device tells.
    pub(super) fn observe(&mut self, stage: &Stage) {
        self.timings.observe(stage);
    }

    /// Does what a key asks for.
    pub(super) fn act(&mut self, action: Action, document: &mut Document) -> Vec<Wish> {
        let mut wishes = Vec::new();
        match action {
            Action::ToggleInterface => self.is_visible = !self.is_visible,
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
                        wishes.push(Wish::Copy(line));
                    }
                    Err(error) => self.complain(&error.to_string()),
                }
            }
            other => document.act(other, &mut self.notes),
        }
        wishes
    }

    /// Lays everything out.
    pub(super) fn show(&mut self, ui: &mut Ui, document: Option<&mut Document>) -> Vec<Wish> {
        let mut wishes = Vec::new();
        if self.is_visible {
            if let Some(document) = document {
                self.sky_dome.show(ui, document);
                self.panel(ui, document, &mut wishes);
                self.probe.show(ui, document);
                self.timings.show(ui, document);
                legend::show(ui, &document.job.settings);
            }
            help::show(ui, &mut self.help);
        }
        self.notes.show(ui, self.is_visible);
        wishes
    }

    fn panel(&mut self, ui: &mut Ui, document: &mut Document, wishes: &mut Vec<Wish>) {
        let frame = style::backdrop().corner_radius(0);
        Panel::left("panel")
            .frame(frame)
            .default_size(290.0)
            .size_range(250.0..=420.0)
            .show_separator_line(false)
            .show(ui, |ui| {
                status::header(ui, document, wishes);
                ScrollArea::vertical().show(ui, |ui| self.sections(ui, document, wishes));
            });
    }

    fn sections(&mut self, ui: &mut Ui, document: &mut Document, wishes: &mut Vec<Wish>) {
        section(ui, "Sun", true, |ui| {
            sun::show(ui, document, &mut self.place, &mut self.clock);
            self.sky_dome.switches(ui);
        });
        section(ui, "Air and ground", true, |ui| air::show(ui, document));
        section(ui, "Picture", true, |ui| {
            picture::show(ui, document, wishes);
        });
        section(ui, "Light", false, |ui| {
            self.light.show(ui, document);
        });
        section(ui, "View", false, |ui| {
            status::view(ui, document);
        });
        section(ui, "Scene", false, |ui| {
            status::scene(ui, document, wishes, &self.timings);
        });
    }
}

/// A part of the panel that folds.
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

/// A labelled line with one of the values of an option, named as on the command line. Returns whether it changed.
fn choice<T: clap::ValueEnum + PartialEq>(ui: &mut Ui, label: &str, value: &mut T) -> bool {
    let name = crate::settings::name;
    let mut changed = false;
    egui::ComboBox::new(label, label)
        .selected_text(name(value.clone()))
        .show_ui(ui, |ui| {
            for variant in T::value_variants() {
                let text = name(variant.clone());
                changed |= ui.selectable_value(value, variant.clone(), text).changed();
            }
        });
    changed
}

/// A box anchored to a corner of the picture.
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
