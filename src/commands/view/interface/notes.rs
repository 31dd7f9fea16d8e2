//! Messages over the image: notices, errors, loading progress.

use std::time::{Duration, Instant};

use egui::{Align2, ProgressBar, RichText, Ui};

use super::corner;
use crate::commands::view::style;

/// Display time of a notice.
const SHOWN: Duration = Duration::from_secs(5);
/// Display time of a hint.
const HINTED: Duration = Duration::from_secs(20);
/// Largest number of messages; older ones are dropped.
const MOST: usize = 6;

/// A message.
struct Note {
    text: String,
    /// When it disappears. `None` for errors, which stay until dismissed.
    until: Option<Instant>,
}

/// The messages on screen.
pub(in crate::commands::view) struct Notes {
    notes: Vec<Note>,
    is_quiet: bool,
    /// Loading progress, 0..1, and stage.
    pub(super) loading: Option<(f32, &'static str)>,
}

impl Notes {
    pub(super) fn new(is_quiet: bool) -> Self {
        Self {
            notes: Vec::new(),
            is_quiet,
            loading: None,
        }
    }

    /// Shows a notice for a few seconds.
    pub(in crate::commands::view) fn say(&mut self, text: &str) {
        if !self.is_quiet {
            self.add(text, Some(Instant::now() + SHOWN));
        }
    }

    /// Shows a notice that takes longer to try out than to read.
    pub(super) fn hint(&mut self, text: &str) {
        if !self.is_quiet {
            self.add(text, Some(Instant::now() + HINTED));
        }
    }

    /// Shows a warning for a few seconds.
    pub(in crate::commands::view) fn warn(&mut self, text: &str) {
        self.add(text, Some(Instant::now() + SHOWN));
    }

    /// Shows an error, in the window and on stderr.
    pub(in crate::commands::view) fn complain(&mut self, text: &str) {
        crate::output::message::error(text);
        self.add(text, None);
    }

    fn add(&mut self, text: &str, until: Option<Instant>) {
        self.notes.retain(|note| note.text != text);
        self.notes.push(Note {
            text: text.to_owned(),
            until,
        });
        let excess = self.notes.len().saturating_sub(MOST);
        self.notes.drain(..excess);
    }

    /// Removes all messages.
    pub(super) fn dismiss(&mut self) {
        self.notes.clear();
    }

    /// Shows the messages, or only errors and progress if `all` is false.
    pub(super) fn show(&mut self, ui: &Ui, all: bool) {
        let now = Instant::now();
        self.notes
            .retain(|note| note.until.is_none_or(|until| until > now));
        if let Some(next) = self.notes.iter().filter_map(|note| note.until).min() {
            ui.ctx().request_repaint_after(next - now);
        }
        let is_shown = |note: &Note| all || note.until.is_none();
        if !self.notes.iter().any(is_shown) && self.loading.is_none() {
            return;
        }
        let mut closed = None;
        corner(ui, "notes", Align2::CENTER_TOP, [0.0, 12.0], |ui| {
            ui.set_max_width(620.0);
            if let Some((share, stage)) = self.loading {
                ui.add(ProgressBar::new(share).desired_width(300.0).text(stage));
            }
            let shown = self.notes.iter().enumerate().filter(|(_, n)| is_shown(n));
            for (i, note) in shown {
                if line(ui, note) {
                    closed = Some(i);
                }
            }
        });
        if let Some(i) = closed {
            self.notes.remove(i);
        }
    }
}

/// Shows a message; returns whether the user dismissed it.
fn line(ui: &mut Ui, note: &Note) -> bool {
    let Some(_) = note.until else {
        let mut close = false;
        ui.horizontal_wrapped(|ui| {
            ui.label(RichText::new(&note.text).color(style::ALARM));
            close = ui.button("dismiss").clicked();
        });
        return close;
    };
    ui.label(&note.text);
    false
}
