//! The window and its device: combines frames and the user interface.

use std::sync::Arc;
use std::time::{Duration, Instant};

use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::ActiveEventLoop;
use winit::window::Window;

use crate::commands::job::{context_options, notice, planned_fault};
use crate::daylight::colour::{BT709_PRIMARIES, D65_WHITE};
use crate::error::{Error, Result};
use crate::gpu::{
    Content, Context, ContextOptions, Format, GpuError, Image, ImageDesc, Overlay, Presenter,
    Recorder, Timing, Timings, UiFrame,
};
use crate::options::{Hdr, Options};
use crate::passes::picture::present::{Present, interface_format};
use crate::passes::route::settle_route;

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
    /// Size of the window, pixels, as its last event told: asking a window that is already gone would end the program.
    size: PhysicalSize<u32>,
    started: Instant,
}

/// What the window can show.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Screen {
    /// Whether the window's surface offers an HDR signal.
    pub(super) offers_hdr: bool,
    /// Whether the window has one.
    pub(super) is_hdr: bool,
}

/// What is left of a stage whose device is lost.
pub(super) struct Left {
    window: Arc<Window>,
    size: PhysicalSize<u32>,
    /// What the user interface remembers: open sections, positions.
    memory: egui::Memory,
}

/// A laid-out user interface.
pub(super) struct Layout {
    pub(super) frame: UiFrame,
    /// Delay until the interface needs another layout.
    pub(super) again_after: Duration,
}

/// Opens the window; returns it with its size, pixels.
///
/// # Errors
/// Fails when the window cannot be created.
pub(super) fn window(
    event_loop: &ActiveEventLoop,
    options: &Options,
) -> Result<(Arc<Window>, PhysicalSize<u32>)> {
    let attributes = Window::default_attributes()
        .with_title("skylight")
        .with_inner_size(PhysicalSize::new(options.size.width, options.size.height))
        .with_visible(false);
    let window = event_loop.create_window(attributes);
    let window = window.map_err(|e| GpuError::Window(super::reason(&e)))?;
    // Nobody closes a window that is not shown yet, and asking a closed one for its size would end the program.
    let size = window.inner_size();
    window.set_visible(true);
    Ok((Arc::new(window), size))
}

impl Stage {
    /// Opens a device that can present to a new window of this size.
    ///
    /// # Errors
    /// Fails when no device is usable.
    pub(super) fn new(
        (window, size): (Arc<Window>, PhysicalSize<u32>),
        options: &Options,
    ) -> Result<Self> {
        Self::on(window, size, options, context_options(options))
    }

    /// Closes everything but the window.
    pub(super) fn leave(self) -> Left {
        Left {
            window: self.window.clone(),
            size: self.size,
            memory: self.ui().memory(Clone::clone),
        }
    }

    /// Opens another device on a window that is left.
    ///
    /// # Errors
    /// Fails when no device is usable.
    pub(super) fn again(left: Left, options: &Options) -> Result<Self> {
        let device = ContextOptions {
            fault: planned_fault(1),
            ..context_options(options)
        };
        let stage = Self::on(left.window, left.size, options, device)?;
        stage.ui().memory_mut(|memory| *memory = left.memory);
        Ok(stage)
    }

    fn on(
        window: Arc<Window>,
        size: PhysicalSize<u32>,
        options: &Options,
        device: ContextOptions,
    ) -> Result<Self> {
        let (context, surface) = Context::for_window(&device, window.clone())?;
        if !(options.quiet || options.no_warnings) {
            notice(&context);
        }
        settle_route(&context)?;
        let mut presenter = Presenter::new(surface, size.into(), false)?;
        let output = presenter.output();
        let interface = interface_format(output);
        let recorder = presenter.idle()?;
        let mut stage = Self {
            overlay: Overlay::new(&context, interface)?,
            present: Present::new(&context, output, interface)?,
            blank: blank(recorder)?,
            egui: egui_state(&window, &context),
            presenter,
            context,
            window,
            size,
            started: Instant::now(),
        };
        stage.set_hdr(options.hdr, options.hdr_peak)?;
        Ok(stage)
    }

    /// Draws with an HDR signal for a screen of this `peak`, cd/m², or without. On an error the window has none.
    ///
    /// # Errors
    /// Fails when one is insisted on and the surface offers none, and when the device cannot create the resources.
    pub(super) fn set_hdr(&mut self, hdr: Hdr, peak: f64) -> Result<()> {
        self.presenter.set_content(Content {
            primaries: BT709_PRIMARIES,
            white: D65_WHITE,
            peak,
        });
        let output = self.presenter.output_for(hdr != Hdr::Off);
        if output != self.presenter.output() {
            self.presenter.idle()?;
            let interface = interface_format(self.presenter.output_for(false));
            self.present = Present::new(&self.context, output, interface)?;
            self.presenter.set_output(output);
        }
        if hdr == Hdr::On && !self.screen().is_hdr {
            return Err(Error::NoHdr(self.presenter.offered()));
        }
        Ok(())
    }

    /// What the window can show.
    pub(super) fn screen(&self) -> Screen {
        let hdr = self.presenter.output_for(true);
        Screen {
            offers_hdr: hdr.encoding.is_hdr(),
            is_hdr: self.presenter.output().encoding.is_hdr(),
        }
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

    /// Follows a change of the window's size, pixels, which may be zero.
    pub(super) fn resize(&mut self, size: PhysicalSize<u32>) {
        self.size = size;
        self.presenter.resize(size.into());
    }

    /// Size of the window, pixels.
    pub(super) fn size(&self) -> PhysicalSize<u32> {
        self.size
    }

    /// The input of the user interface since the last layout. `egui_winit::State::take_egui_input` asks the window for its size.
    fn input(&mut self) -> egui::RawInput {
        let scale = egui_winit::pixels_per_point(self.ui(), &self.window);
        let native = self.window.scale_factor() as f32;
        let seconds = self.started.elapsed().as_secs_f64();
        let size = egui::vec2(self.size.width as f32, self.size.height as f32) / scale;
        let input = self.egui.egui_input_mut();
        input.time = Some(seconds);
        let has_area = size.x > 0.0 && size.y > 0.0;
        input.screen_rect = has_area.then(|| egui::Rect::from_min_size(egui::Pos2::ZERO, size));
        input.viewport_id = egui::ViewportId::ROOT;
        let viewport = input.viewports.entry(egui::ViewportId::ROOT).or_default();
        viewport.native_pixels_per_point = Some(native);
        input.take()
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
        let input = self.input();
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

    /// Waits until the next frame may be recorded. Returns whether there was anything to wait for.
    ///
    /// # Errors
    /// Fails when the device is lost.
    pub(super) fn wait_for_turn(&mut self) -> Result<bool> {
        Ok(self.presenter.wait_for_turn()?)
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
