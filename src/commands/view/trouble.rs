//! What the window does about errors: it opens a lost device once more, and ends with one line otherwise.

use std::path::PathBuf;
use std::time::Instant;

use winit::event_loop::ActiveEventLoop;

use crate::error::{Error, Result};

use super::app::{App, RETRY};
use super::document::Document;
use super::stage::Stage;

const RECOVERED: &str =
    "the device was lost (driver fault or reset) and was opened again; the view is the same";

/// What an error leads to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Verdict {
    /// Open the device once more.
    Recover,
    /// End the program now.
    End,
    /// End the program, unless a reason turns up at once that explains the error: drawing to a window that another program destroyed
    /// fails in many ways, and the window system tells of it a little later.
    EndSoon,
}

/// Errors so far.
#[derive(Debug, Default)]
pub(super) struct Trouble {
    has_recovered: bool,
    /// The error that ends the program.
    error: Option<Error>,
    /// A scene whose upload a lost device ended.
    unopened: Option<Option<PathBuf>>,
}

impl Trouble {
    fn verdict(&mut self, error: &Error) -> Verdict {
        match error {
            Error::WindowGone => Verdict::End,
            lost if lost.is_device_lost() => {
                if std::mem::replace(&mut self.has_recovered, true) {
                    Verdict::End
                } else {
                    Verdict::Recover
                }
            }
            _ => Verdict::EndSoon,
        }
    }

    /// Ends the program with this error, in place of one that it explains.
    pub(super) fn end(&mut self, error: Error) {
        if self.error.is_none() || matches!(error, Error::WindowGone) {
            self.error = Some(error);
        }
    }

    /// Whether the program is about to end.
    pub(super) fn is_ending(&self) -> bool {
        self.error.is_some()
    }

    /// The error that ended the program.
    pub(super) fn take(&mut self) -> Option<Error> {
        self.error.take()
    }

    /// Notes that a scene could not be uploaded because the device was lost.
    pub(super) fn keep_unopened(&mut self, error: &Error, scene: Option<PathBuf>) {
        if error.is_device_lost() {
            self.unopened = Some(scene);
        }
    }
}

impl App {
    /// Does what there is to do about an error.
    pub(super) fn trouble_of(&mut self, event_loop: &ActiveEventLoop, error: Error) {
        match self.trouble.verdict(&error) {
            // A device that is lost before there is a view has nothing to recover.
            Verdict::Recover if self.stage.is_none() => {
                self.trouble.end(error);
                event_loop.exit();
            }
            Verdict::Recover => {
                if let Err(error) = self.recover() {
                    self.trouble.end(Error::LostForGood(Box::new(error)));
                    event_loop.exit();
                }
            }
            Verdict::End => {
                self.trouble.end(error);
                event_loop.exit();
            }
            Verdict::EndSoon => {
                self.trouble.end(error);
                self.again_at = Some(Instant::now() + RETRY);
            }
        }
    }

    /// Opens the device once more, on the same window with the same view.
    fn recover(&mut self) -> Result<()> {
        // Whatever comes of it, the settings are kept.
        self.keep_settings();
        if let Some(scene) = self.drop_openings() {
            self.trouble.unopened = Some(scene);
        }
        let aside = self.document.take().map(Document::lay_aside);
        let Some(left) = self.stage.take().map(Stage::leave) else {
            return Ok(());
        };
        let mut stage = Stage::again(left, &self.options)?;
        stage.set_timed(self.interface.is_timed());
        if let Some(aside) = aside {
            let (screen, wake) = (stage.screen(), self.loader.wake());
            self.document = Some(aside.on((&stage.context, &wake), screen)?);
        }
        if let Some(scene) = self.trouble.unopened.take() {
            self.interface.loading(Some((0.0, "opening")));
            self.loader.start(scene, &self.options);
        }
        if !self.options.no_warnings {
            crate::output::message::warning(RECOVERED);
        }
        self.interface.warn(RECOVERED);
        stage.window.request_redraw();
        self.stage = Some(stage);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::GpuError;

    fn lost() -> Error {
        Error::Gpu(GpuError::lost())
    }

    #[test]
    fn a_device_is_opened_once_more_and_not_twice() {
        let mut trouble = Trouble::default();
        assert_eq!(trouble.verdict(&lost()), Verdict::Recover);
        assert!(!trouble.is_ending());
        assert_eq!(trouble.verdict(&lost()), Verdict::End);
    }

    #[test]
    fn a_window_that_is_gone_explains_what_failed_before() {
        let mut trouble = Trouble::default();
        let failed = Error::Gpu(GpuError::Window("no surface".into()));
        assert_eq!(trouble.verdict(&failed), Verdict::EndSoon);
        trouble.end(failed);
        assert_eq!(trouble.verdict(&Error::WindowGone), Verdict::End);
        trouble.end(Error::WindowGone);
        trouble.end(lost());
        assert!(matches!(trouble.take(), Some(Error::WindowGone)));
    }

    #[test]
    fn only_a_lost_device_lets_a_scene_be_loaded_again() {
        let mut trouble = Trouble::default();
        trouble.keep_unopened(&Error::WindowGone, None);
        assert!(trouble.unopened.is_none());
        trouble.keep_unopened(&lost(), Some("house.obj".into()));
        assert_eq!(trouble.unopened, Some(Some("house.obj".into())));
    }
}
