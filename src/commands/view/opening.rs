//! From a loaded scene to an open one: another thread uploads it and makes its passes, and the window goes on with the scene before.

use std::path::PathBuf;

use super::app::{App, tell, window_size};
use super::background::Background;
use super::document::Document;
use crate::error::Result;
use crate::scene::{Loaded, SceneError};

/// Result of loading a scene.
pub(super) type Opened = Box<std::result::Result<Loaded, SceneError>>;

/// A scene that is being prepared for the device.
pub(super) struct Opening {
    /// Number of its load.
    ticket: u64,
    path: Option<PathBuf>,
    work: Background<Result<Document>>,
}

impl App {
    /// Prepares a loaded scene, or shows the error that prevented loading.
    pub(super) fn opened(&mut self, ticket: u64, path: Option<PathBuf>, result: Opened) {
        let Some(stage) = &mut self.stage else {
            self.waiting = Some((ticket, path, result));
            return;
        };
        let loaded = match *result {
            Ok(loaded) => loaded,
            Err(error) => return self.show(path, Err(error.into())),
        };
        self.interface.loading(Some((1.0, "preparing")));
        let (user, context, wake) = (self.user.clone(), stage.context.clone(), self.loader.wake());
        let window = (window_size(stage), stage.screen());
        let of = path.clone();
        let open = {
            let wake = wake.clone();
            move || {
                let opened = Document::open((&context, &wake), of, loaded, user, window)?;
                opened.job.check_strict()?;
                Ok(opened)
            }
        };
        let work = Background::start(&wake, open);
        self.openings.push(Opening { ticket, path, work });
        self.request_redraw();
    }

    /// Shows the scenes that are ready by now. Those that a newer one has superseded are dropped.
    pub(super) fn look_for_opened(&mut self) {
        for mut opening in std::mem::take(&mut self.openings) {
            match opening.work.result() {
                Some(opened) if self.loader.is_newest(opening.ticket) => {
                    self.show(opening.path, opened);
                }
                Some(_) => {}
                None => self.openings.push(opening),
            }
        }
    }

    /// Waits for the scenes that are being prepared, since they use the device, and drops them. Returns the path of the newest one, if it was among them.
    pub(super) fn drop_openings(&mut self) -> Option<Option<PathBuf>> {
        let mut newest = None;
        for opening in std::mem::take(&mut self.openings) {
            drop(opening.work.wait());
            if self.loader.is_newest(opening.ticket) {
                newest = Some(opening.path);
            }
        }
        newest
    }

    /// Shows a scene, or the error that prevented that.
    fn show(&mut self, path: Option<PathBuf>, opened: Result<Document>) {
        let Some(stage) = &mut self.stage else {
            return;
        };
        self.interface.loading(None);
        match opened {
            Ok(document) => {
                let is_told = !self.options.no_warnings;
                for warning in document.job.warnings().filter(|_| is_told) {
                    self.interface.warn(warning);
                }
                let title = format!("{} \u{2013} skylight", document.title());
                stage.window.set_title(&title);
                if self.document.is_none() {
                    self.interface.hint();
                }
                // Frames in flight use the scene before; on a lost device none are.
                let _ = stage.idle();
                self.document = Some(document);
            }
            Err(error) => {
                self.trouble.keep_unopened(&error, path);
                tell(&mut self.interface, &error);
            }
        }
        self.request_redraw();
    }
}
