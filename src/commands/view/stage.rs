//! The window and its device: combines frames and the user interface.

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

/// The window, its device, and what draws to the swapchain.
pub(super) struct Stage {
    overlay: Overlay,
    present: Present,
    presenter: Presenter,
    /// Shown until there is a first image.
    blank: Image,
    egui: egui_winit::State,
    pub(super) context: Arc<Context>,
    pub(super) window: Arc<Window>,
}

/// A laid-out user interface.
pub(super) struct Layout {
    pub(super) frame: UiFrame,
    /// Delay until the interface needs another layout.
    pub(super) again_after: Duration,
}

impl Stage {
    /// Opens the window and a device that can present to it.
    ///
    /// # Errors
    /// Fails when the window cannot be created or no device is usable.
    pub(super) fn new(event_loop: &ActiveEventLoop, options: &Options) -> Result<Self> {
        let attributes = Window::default_attributes()
            .with_title("skylight")
            .with_inner_size(PhysicalSize::new(options.size.width, options.size.height));
        let window = event_loop
            .create_window(attributes)
            .map_err(|e| GpuError::Window(super::reason(&e)))?;
        let window = Arc::new(window);
        let (context, surface) = Context::for_window(&context_options(options), window.clone())?;
        if !(options.quiet || options.no_warnings) {
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

    /// Passes an event to the user interface. Returns whether the interface consumed it, and whether it needs another
    /// layout.
    pub(super) fn on_event(&mut self, event: &WindowEvent) -> (bool, bool) {
        let response = self.egui.on_window_event(&self.window, event);
        (response.consumed, response.repaint)
    }

    /// The egui context.
    pub(super) fn ui(&self) -> &egui::Context {
        self.egui.egui_ctx()
    }

    /// Follows a change of the window's size, which may be zero.
    pub(super) fn resize(&mut self) {
        self.presenter.resize(self.window.inner_size().into());
    }

    /// Lays out the user interface.
    ///
    /// # Errors
    /// Fails when there is no memory for the interface's textures.
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

    /// Draws a frame: the document if it needs drawing, with the user interface on top. Returns false when the window cannot
    /// be drawn to at the moment.
    ///
    /// # Errors
    /// A lost device, or not enough memory.
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

    /// Does work outside of frames, with nothing in flight, and waits for it. Work that fails is not submitted.
    ///
    /// # Errors
    /// Any error of `work`, or a lost device.
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

    /// The recorder, not recording and with nothing in flight.
    ///
    /// # Errors
    /// Fails when the device is lost.
    pub(super) fn idle(&mut self) -> Result<&mut Recorder> {
        Ok(self.presenter.idle()?)
    }

    /// Turns pass timing on or off from the next frame. Without reliable timestamps each pass is submitted alone.
    pub(super) fn set_timed(&mut self, timed: bool) {
        let timing = self.context.summary().timing();
        self.presenter
            .set_timing(if timed { timing } else { Timing::Off });
    }

    /// Pass times of the newest completed frame.
    pub(super) fn timings(&self) -> &Timings {
        self.presenter.timings()
    }
}

/// A dark image of one texel.
fn blank(recorder: &mut Recorder) -> Result<Image> {
    let context = recorder.context().clone();
    let format = Format::R8G8B8A8_UNORM;
    let image = Image::new(&context, &ImageDesc::flat("no picture", format, [1, 1]))?;
    recorder.begin()?;
    recorder.clear(&image, [0.15, 0.15, 0.17, 1.0]);
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
