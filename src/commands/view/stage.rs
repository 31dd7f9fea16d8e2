//! The window with its device: where frames and the user interface are put together.

use std::sync::Arc;
use std::time::Duration;

use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::ActiveEventLoop;
use winit::window::Window;

use crate::commands::job::{context_options, notice};
use crate::error::Result;
use crate::gpu::{
    Context, Format, GpuError, Image, ImageDesc, Overlay, Presenter, Recorder, Timing, Timings,
    UiFrame,
};
use crate::options::Options;
use crate::passes::picture::present::Present;

use super::document::Document;

/// The window, its device, and what draws to it.
pub(super) struct Stage {
    overlay: Overlay,
    present: Present,
    presenter: Presenter,
    /// Stands for a picture before the first.
    blank: Image,
    egui: egui_winit::State,
    pub(super) context: Arc<Context>,
    pub(super) window: Arc<Window>,
}

/// A user interface, laid out.
pub(super) struct Layout {
    pub(super) frame: UiFrame,
    /// When it wants to be laid out again.
    pub(super) again_after: Duration,
}

impl Stage {
    /// Opens the window and a device that presents to it.
    ///
    /// # Errors
    /// When the window system or every device refuses.
    pub(super) fn new(event_loop: &ActiveEventLoop, options: &Options) -> Result<Self> {
        let attributes = Window::default_attributes()
            .with_title("skylight")
            .with_inner_size(PhysicalSize::new(options.size.width, options.size.height));
        let window = event_loop
            .create_window(attributes)
            .map_err(|e| GpuError::Window(super::reason(&e)))?;
        let window = Arc::new(window);
        let (context, surface) = Context::for_window(&context_options(options), window.clone())?;
        if !options.quiet {
            notice(&context);
        }
        let mut presenter = Presenter::new(surface, window.inner_size().into())?;
        let format = presenter.format();
        let recorder = presenter.idle()?;
        Ok(Self {
            overlay: Overlay::new(&context, format)?,
            present: Present::new(&context, format)?,
            blank: blank(recorder)?,
            egui: egui_state(&window, &context),
            presenter,
            context,
            window,
        })
    }

    /// Shows an event to the user interface. Returns whether it keeps the event to itself, and whether it wants to be
    /// laid out again.
    pub(super) fn on_event(&mut self, event: &WindowEvent) -> (bool, bool) {
        let response = self.egui.on_window_event(&self.window, event);
        (response.consumed, response.repaint)
    }

    /// The user interface's own state.
    pub(super) fn ui(&self) -> &egui::Context {
        self.egui.egui_ctx()
    }

    /// The window has another size, or none.
    pub(super) fn resize(&mut self) {
        self.presenter.resize(self.window.inner_size().into());
    }

    /// Lays out the user interface.
    ///
    /// # Errors
    /// When memory for its textures is out.
    pub(super) fn lay_out(
        &mut self,
        event_loop: &ActiveEventLoop,
        content: impl FnMut(&mut egui::Ui),
    ) -> Result<Layout> {
        let input = self.egui.take_egui_input(&self.window);
        let context = self.ui().clone();
        let output = context.run_ui(input, content);
        self.egui.handle_platform_output_with_event_loop(
            &self.window,
            event_loop,
            output.platform_output,
        );
        self.overlay.update(output.textures_delta)?;
        let again_after = output
            .viewport_output
            .values()
            .map(|viewport| viewport.repaint_delay)
            .min();
        Ok(Layout {
            frame: UiFrame {
                primitives: context.tessellate(output.shapes, output.pixels_per_point),
                pixels_per_point: output.pixels_per_point,
            },
            again_after: again_after.unwrap_or(Duration::MAX),
        })
    }

    /// Draws a frame: the document when it wants to be, and the user interface over it. False when the window cannot be
    /// drawn to now.
    ///
    /// # Errors
    /// A lost device, or memory that is out.
    pub(super) fn draw(
        &mut self,
        ui: &UiFrame,
        mut document: Option<&mut Document>,
    ) -> Result<bool> {
        let Self {
            overlay,
            present,
            presenter,
            blank,
            ..
        } = self;
        presenter.frame(|recorder, window| {
            if let Some(document) = document.as_deref_mut() {
                document.record(recorder);
            }
            let display = document.as_deref().map_or(&*blank, Document::display);
            Ok(present.record(recorder, display, overlay, ui, window)?)
        })
    }

    /// Does work outside of frames, when nothing is in flight, and waits for it. Work that fails is not submitted.
    ///
    /// # Errors
    /// Whatever `work` returns, or a lost device.
    pub(super) fn work<T>(&mut self, work: impl FnOnce(&mut Recorder) -> Result<T>) -> Result<T> {
        let recorder = self.presenter.idle()?;
        recorder.begin()?;
        let result = work(recorder);
        match result {
            Ok(_) => recorder.finish()?,
            Err(_) => recorder.abandon()?,
        }
        result
    }

    /// A recorder that is not recording, when nothing is in flight.
    ///
    /// # Errors
    /// When the device is lost.
    pub(super) fn idle(&mut self) -> Result<&mut Recorder> {
        Ok(self.presenter.idle()?)
    }

    /// Times passes from the next frame on, or stops it. Timestamps of software drivers mean little: there each pass is
    /// submitted alone.
    pub(super) fn set_timed(&mut self, timed: bool) {
        let software = self.context.summary().is_software();
        self.presenter.set_timing(match (timed, software) {
            (false, _) => Timing::Off,
            (true, true) => Timing::Isolated,
            (true, false) => Timing::Timestamps,
        });
    }

    /// Times of the newest frame that is done.
    pub(super) fn timings(&self) -> &Timings {
        self.presenter.timings()
    }
}

/// One dark texel.
fn blank(recorder: &mut Recorder) -> Result<Image> {
    let context = recorder.context().clone();
    let format = Format::R8G8B8A8_SRGB;
    let image = Image::new(&context, &ImageDesc::flat("no picture", format, [1, 1]))?;
    recorder.begin()?;
    recorder.clear(&image, [0.02, 0.02, 0.025, 1.0]);
    recorder.finish()?;
    Ok(image)
}

fn egui_state(window: &Window, context: &Context) -> egui_winit::State {
    let ui = egui::Context::default();
    super::style::apply(&ui);
    let edge = context.summary().max_image_edge as usize;
    egui_winit::State::new(
        ui,
        egui::ViewportId::ROOT,
        window,
        Some(window.scale_factor() as f32),
        window.theme(),
        Some(edge),
    )
}
