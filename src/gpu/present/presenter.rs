//! Presentation of frames to a window with two frames in flight: the CPU records one while the device renders the other.

use ash::vk;

use crate::gpu::device::surface::Surface;
use crate::gpu::error::{GpuError, Result};
use crate::gpu::memory::image::Image;
use crate::gpu::present::output::{Content, Output, choose, listed};
use crate::gpu::present::swapchain::{Semaphore, Swapchain};
use crate::gpu::record::access::ImageAccess;
use crate::gpu::record::recorder::Recorder;
use crate::gpu::record::timings::{Timing, Timings};

/// Frames in flight.
pub const FRAMES: usize = 2;

/// Resources of one frame in flight.
struct Slot {
    recorder: Recorder,
    acquired: Semaphore,
}

/// Records and presents frames.
pub struct Presenter {
    slots: [Slot; FRAMES],
    current: usize,
    swapchain: Swapchain,
    offered: Vec<vk::SurfaceFormatKHR>,
}

impl Presenter {
    /// Creates a presenter for a window of `size` pixels, with an HDR signal if `hdr` and the surface offers one.
    ///
    /// # Errors
    /// When the surface offers no format that the program draws to, or memory is exhausted.
    pub fn new(surface: Surface, size: [u32; 2], hdr: bool) -> Result<Self> {
        let context = surface.context().clone();
        let slot = || -> Result<Slot> {
            Ok(Slot {
                recorder: Recorder::new(&context, Timing::Off)?,
                acquired: Semaphore::new(&context)?,
            })
        };
        let offered = surface.formats()?;
        let output = choose(&offered, hdr).ok_or_else(|| {
            let there_are = listed(&offered);
            GpuError::Window(format!("skylight knows none of its formats ({there_are})"))
        })?;
        Ok(Self {
            slots: [slot()?, slot()?],
            current: 0,
            swapchain: Swapchain::new(surface, size, output)?,
            offered,
        })
    }

    /// What the window is drawn in.
    pub fn output(&self) -> Output {
        self.swapchain.output()
    }

    /// What the window can be drawn in: with an HDR signal if `hdr` and the surface offers one, or without.
    pub fn output_for(&self, hdr: bool) -> Output {
        choose(&self.offered, hdr).unwrap_or(self.output())
    }

    /// The formats and colour spaces that the surface offers, for a message.
    pub fn offered(&self) -> String {
        listed(&self.offered)
    }

    /// Sets what the window is drawn in from the next frame on: one of [`Presenter::output_for`].
    pub fn set_output(&mut self, output: Output) {
        self.swapchain.set_output(output);
    }

    /// Sets what the pictures hold at most, which an HDR screen is told where the device can ([`crate::gpu::Optional::HdrMetadata`]).
    pub fn set_content(&mut self, content: Content) {
        self.swapchain.set_content(content);
    }

    /// Sets the window size, pixels; 0 when minimised.
    pub fn resize(&mut self, size: [u32; 2]) {
        self.swapchain.resize(size);
    }

    /// Waits until the next frame may be recorded: until the one before the newest is drawn. Returns whether there was anything to wait
    /// for.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn wait_for_turn(&mut self) -> Result<bool> {
        let recorder = &mut self.slots[self.current].recorder;
        let is_pending = recorder.is_pending();
        recorder.wait().map(|()| is_pending)
    }

    /// Records a frame that renders to a swapchain image, and presents it. Returns false without recording if the window has
    /// zero area or is being resized.
    ///
    /// # Errors
    /// The error of `record`, or a lost device.
    pub fn frame<E: From<crate::gpu::GpuError>>(
        &mut self,
        record: impl FnOnce(&mut Recorder, &Image) -> std::result::Result<(), E>,
    ) -> std::result::Result<bool, E> {
        let slot = &mut self.slots[self.current];
        slot.recorder.wait()?;
        let Some(index) = self.swapchain.acquire(slot.acquired.raw)? else {
            return Ok(false);
        };
        let image = self.swapchain.image(index);
        slot.recorder.begin()?;
        slot.recorder.wait_for(slot.acquired.raw);
        // The acquired image is presented even if `record` fails; otherwise the window would freeze.
        let recorded = record(&mut slot.recorder, image);
        slot.recorder
            .transition([(image, ImageAccess::Present)].into_iter());
        slot.recorder.submit(Some(self.swapchain.drawn(index)))?;
        self.swapchain.present(index)?;
        self.current = (self.current + 1) % FRAMES;
        recorded.map(|()| true)
    }

    /// Waits for the frames in flight and returns a recorder for other work.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn idle(&mut self) -> Result<&mut Recorder> {
        for slot in &mut self.slots {
            slot.recorder.wait()?;
        }
        Ok(&mut self.slots[self.current].recorder)
    }

    /// Sets how passes are timed.
    pub fn set_timing(&mut self, timing: Timing) {
        for slot in &mut self.slots {
            slot.recorder.set_timing(timing);
        }
    }

    /// Pass times of the last finished frame.
    pub fn timings(&self) -> &Timings {
        self.slots[self.current].recorder.timings()
    }
}
