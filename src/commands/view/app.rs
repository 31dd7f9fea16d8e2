//! The event loop: turns events into changes and changes into frames.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::window::{Fullscreen, Window};

use crate::error::{Error, Result};
use crate::gpu::FRAMES;
use crate::options::{Hdr, Options, Size};

use super::capture;
use super::document::{Asked, Document};
use super::input::Input;
use super::interface::{Interface, UiRequest};
use super::keys::Action;
use super::loader::{Loader, Message};
use super::opening::{Opened, Opening};
use super::pace::Pace;
use super::stage::Stage;
use super::touch::Touches;
use super::trouble::Trouble;

/// Retry interval when the window cannot be drawn to.
pub(super) const RETRY: Duration = Duration::from_millis(100);

/// Application state.
pub(super) struct App {
    /// What the command line asks for.
    pub(super) user: Asked,
    /// The command-line options over the defaults, without those of a scene.
    pub(super) options: Options,
    pub(super) loader: Loader,
    /// A scene that was loaded before the window existed.
    pub(super) waiting: Option<(u64, Option<PathBuf>, Opened)>,
    /// Scenes that other threads prepare for the device.
    pub(super) openings: Vec<Opening>,
    // Declared before the stage so that it is dropped first: it uses the stage's device.
    pub(super) document: Option<Document>,
    pub(super) stage: Option<Stage>,
    /// The window, from its creation to the end: if it is destroyed meanwhile, another program did it.
    pub(super) window: Option<Arc<Window>>,
    pub(super) interface: Interface,
    pub(super) input: Input,
    pub(super) touches: Touches,
    pub(super) started: Instant,
    /// Start of the newest frame, while something is moving.
    ticked: Option<Instant>,
    /// Time of the next redraw without an event.
    pub(super) again_at: Option<Instant>,
    /// Whether the window could not be drawn to.
    is_blocked: bool,
    /// Whether the next frame of the options is to be saved.
    is_capture_due: bool,
    pub(super) trouble: Trouble,
    /// The measurement of the frames' pace, if it was asked for.
    pace: Option<Pace>,
}

impl App {
    /// Starts loading `scene`. The window is created by the event loop.
    pub(super) fn new(
        proxy: EventLoopProxy<Message>,
        scene: Option<PathBuf>,
        user: Asked,
        options: Options,
    ) -> Self {
        let mut loader = Loader::new(proxy);
        loader.start(scene, &options);
        Self {
            interface: Interface::new(options.quiet),
            user,
            options,
            loader,
            waiting: None,
            openings: Vec::new(),
            document: None,
            stage: None,
            window: None,
            input: Input::default(),
            touches: Touches::default(),
            started: Instant::now(),
            ticked: None,
            again_at: None,
            is_blocked: false,
            is_capture_due: false,
            trouble: Trouble::default(),
            pace: Pace::asked(),
        }
    }

    /// Result of the program, once the event loop has ended.
    pub(super) fn into_result(mut self) -> Result<()> {
        self.document = None;
        match (self.trouble.take(), &self.stage) {
            (Some(error), _) => Err(error),
            (None, Some(stage)) => Ok(stage.context.check_validation()?),
            (None, None) => Ok(()),
        }
    }

    pub(super) fn request_redraw(&self) {
        if let Some(stage) = &self.stage {
            stage.window.request_redraw();
        }
    }

    /// Keeps the settings of the document for `--resume`.
    pub(super) fn keep_settings(&self) {
        if let Some(document) = &self.document
            && let Err(error) = super::resume::keep(document)
            && !self.options.no_warnings
        {
            crate::output::message::warning(error);
        }
    }

    /// Opens another file in the background.
    pub(super) fn open_file(&mut self, path: PathBuf) {
        self.interface.loading(Some((0.0, "opening")));
        // These options refer to the scene of the command line.
        self.user.options.remove(&["camera", "eye", "target"]);
        self.loader.start(Some(path), &self.options);
        self.request_redraw();
    }

    pub(super) fn redraw(&mut self, event_loop: &ActiveEventLoop) -> Result<()> {
        let now = Instant::now();
        let seconds = self
            .ticked
            .map_or(0.0, |before| (now - before).as_secs_f64());
        if let Some(document) = &mut self.document {
            if let Some(pace) = &mut self.pace {
                pace.begin(document, FRAMES);
            }
            document.advance(seconds, self.input.fly_keys());
            self.interface.play(document, seconds);
        }
        self.probe()?;
        let requests = self.lay_out_and_draw(event_loop)?;
        if let (Some(pace), Some(document)) = (&mut self.pace, &mut self.document)
            && pace.end(document)?
        {
            event_loop.exit();
        }
        self.capture();
        for request in requests {
            self.handle(request)?;
        }
        self.ticked = self.is_busy().then_some(now);
        // A message that disappears later does not hold up the frames until then.
        if self.ticked.is_some() && !self.is_blocked {
            self.request_redraw();
        }
        Ok(())
    }

    /// Saves the newest frame if that was asked for, once it has the daylight of the options.
    fn capture(&mut self) {
        let (Some(stage), Some(document)) = (&mut self.stage, &mut self.document) else {
            return;
        };
        if !self.is_capture_due || document.is_behind() {
            return;
        }
        self.is_capture_due = false;
        match capture::save(stage, document) {
            Ok(line) => self.interface.say(&line),
            Err(error) => tell(&mut self.interface, &error),
        }
        stage.window.request_redraw();
    }

    /// Whether another frame is needed without any event.
    fn is_busy(&self) -> bool {
        let moving = self.document.as_ref().is_some_and(|document| {
            !document.is_at_rest()
                || document.controls.is_moving()
                || self.interface.is_playing(document)
        });
        let probed = self
            .interface
            .is_probed(self.probed_pixel(), self.document.as_ref());
        moving || self.input.is_flying() || !probed || self.pace.is_some()
    }

    fn lay_out_and_draw(&mut self, event_loop: &ActiveEventLoop) -> Result<Vec<UiRequest>> {
        let (Some(stage), interface) = (&mut self.stage, &mut self.interface) else {
            return Ok(Vec::new());
        };
        let mut document = self.document.as_mut();
        let size = window_size(stage);
        let mut requests = Vec::new();
        interface.observe(stage);
        let layout = stage.lay_out(event_loop, |ui| {
            requests.extend(interface.show(ui, document.as_deref_mut()));
        })?;
        if let Some(document) = document.as_deref_mut() {
            let is_set = self.pace.as_ref().is_some_and(Pace::sets_size);
            if size.width > 0 && size.height > 0 && !is_set {
                document.job.settings.size = size;
            }
            let settings = &document.job.settings;
            if let Err(error) = stage.set_hdr(settings.hdr, settings.hdr_peak) {
                document.job.settings.hdr = Hdr::Off;
                tell(interface, &error);
            }
            document.set_screen(stage.screen());
            if document.is_behind()
                && let Err(error) = document.follow()
            {
                tell(interface, &error);
            }
            if document.follow_desk() {
                // The interface was laid out before.
                stage.window.request_redraw();
            }
            if let Some(fault) = document.fault.take() {
                interface.complain(&fault);
            }
        }
        let rested = document.as_deref().is_none_or(Document::is_at_rest);
        let drawn = stage.draw(&layout.frame, document.as_deref_mut())?;
        if !rested && document.is_some_and(|d| d.is_at_rest()) {
            // The interface was laid out before this frame and still shows the previous state.
            stage.window.request_redraw();
        }
        self.is_blocked = !drawn;
        self.again_at = match layout.again_after {
            _ if !drawn => Some(Instant::now() + RETRY),
            // Requested for the next frame; no timer needed.
            after if after.is_zero() => {
                stage.window.request_redraw();
                None
            }
            after => Instant::now().checked_add(after),
        };
        Ok(requests)
    }

    /// The image pixel under the pointer, if it is to be probed.
    fn probed_pixel(&self) -> Option<[u32; 2]> {
        let (Some(stage), Some([x, y])) = (&self.stage, self.input.pointer()) else {
            return None;
        };
        let size = self.document.as_ref()?.job.settings.size;
        let inside = x >= 0.0 && y >= 0.0 && x < size.width.into() && y < size.height.into();
        let free = !stage.ui().is_pointer_over_egui() && !self.input.is_dragging();
        (inside && free && self.interface.is_visible()).then_some([x as u32, y as u32])
    }

    fn probe(&mut self) -> Result<()> {
        let pixel = self.probed_pixel();
        if self.interface.is_probed(pixel, self.document.as_ref()) {
            return Ok(());
        }
        let (Some(stage), Some(document), Some(pixel)) =
            (&mut self.stage, &mut self.document, pixel)
        else {
            self.interface.probed(None, None, None);
            return Ok(());
        };
        stage.work(|rec| {
            document.pick(rec, pixel);
            Ok(())
        })?;
        let reading = document.picked();
        self.interface.probed(Some(pixel), reading, Some(document));
        Ok(())
    }

    fn handle(&mut self, request: UiRequest) -> Result<()> {
        match request {
            UiRequest::Do(action) => self.perform(action)?,
            UiRequest::Copy(text) => {
                if let Some(stage) = &self.stage {
                    stage.ui().copy_text(text);
                }
            }
        }
        self.request_redraw();
        Ok(())
    }

    pub(super) fn perform(&mut self, action: Action) -> Result<()> {
        let (Some(stage), Some(document)) = (&mut self.stage, &mut self.document) else {
            return Ok(());
        };
        match action {
            Action::Screenshot => self.is_capture_due = true,
            Action::FullScreen => {
                let full = stage.window.fullscreen().is_none();
                let wanted = full.then_some(Fullscreen::Borderless(None));
                stage.window.set_fullscreen(wanted);
            }
            Action::ToggleTimings => {
                let timed = self.interface.toggle_timings();
                stage.set_timed(timed);
                document.start_over();
            }
            Action::ReloadShaders => match reload(stage, document) {
                Ok(line) => self.interface.say(&line),
                Err(error) => tell(&mut self.interface, &error),
            },
            other => {
                for request in self.interface.perform(other, document) {
                    self.handle(request)?;
                }
            }
        }
        self.request_redraw();
        Ok(())
    }
}

/// Reloads the shaders from disk; returns a message with the number that changed.
#[cfg(feature = "hot-reload")]
fn reload(stage: &mut Stage, document: &mut Document) -> Result<String> {
    let changed = stage.context.reload_shaders()?;
    stage.work(|rec| document.rebuild(rec))?;
    Ok(format!("reloaded the shaders: {changed} changed"))
}

#[cfg(not(feature = "hot-reload"))]
fn reload(_: &mut Stage, _: &mut Document) -> Result<String> {
    Ok("this build does not reload shaders; build with --features hot-reload".to_owned())
}

/// Shows an error, except for a lost device: the next frame finds it lost too ([`App::trouble_of`]).
pub(super) fn tell(interface: &mut Interface, error: &Error) {
    if !error.is_device_lost() {
        interface.complain(&error.to_string());
    }
}

pub(super) fn window_size(stage: &Stage) -> Size {
    let size = stage.size();
    Size {
        width: size.width,
        height: size.height,
    }
}
