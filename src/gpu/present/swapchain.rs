//! The swapchain of a window, recreated when the window changes.

use std::sync::Arc;

use ash::{khr, vk};

use crate::gpu::device::context::Context;
use crate::gpu::device::fault::Call;
use crate::gpu::device::surface::Surface;
use crate::gpu::error::{During, GpuError, Result};
use crate::gpu::memory::image::Image;
use crate::gpu::present::output::{Content, Output};
use crate::gpu::record::access::ImageAccess;

/// A semaphore destroyed on drop.
pub(in crate::gpu) struct Semaphore {
    context: Arc<Context>,
    pub(in crate::gpu) raw: vk::Semaphore,
}

impl Semaphore {
    pub(in crate::gpu) fn new(context: &Arc<Context>) -> Result<Self> {
        // SAFETY: the info has no pointers.
        let raw = unsafe {
            context
                .raw()
                .create_semaphore(&vk::SemaphoreCreateInfo::default(), None)
        }
        .during("create a semaphore")?;
        Ok(Self {
            context: context.clone(),
            raw,
        })
    }
}

impl Drop for Semaphore {
    fn drop(&mut self) {
        if let Some(raw) = self.context.freeing() {
            // SAFETY: the swapchain waits for the device before it releases its semaphores.
            unsafe { raw.destroy_semaphore(self.raw, None) };
        }
    }
}

/// A swapchain image and the semaphore signalled when rendering to it is done.
struct Target {
    image: Image,
    drawn: Semaphore,
}

/// The swapchain of a surface.
pub(in crate::gpu) struct Swapchain {
    // `drop` destroys the swapchain after its views and semaphores; the surface is dropped last.
    targets: Vec<Target>,
    raw: vk::SwapchainKHR,
    loader: khr::swapchain::Device,
    output: Output,
    content: Option<Content>,
    wanted: [u32; 2],
    is_stale: bool,
    surface: Surface,
}

/// Outcome of acquiring an image.
enum Acquired {
    Image(u32),
    Retry,
    Nothing,
}

impl Swapchain {
    /// Creates a swapchain of `size` pixels. The images are created by the first `acquire`.
    pub(in crate::gpu) fn new(surface: Surface, size: [u32; 2], output: Output) -> Result<Self> {
        let context = surface.context().clone();
        let loader = context
            .extensions
            .swapchain
            .clone()
            .ok_or(GpuError::NoDevice)?;
        Ok(Self {
            targets: Vec::new(),
            raw: vk::SwapchainKHR::null(),
            loader,
            output,
            content: None,
            wanted: size,
            is_stale: true,
            surface,
        })
    }

    pub(in crate::gpu) fn context(&self) -> &Arc<Context> {
        self.surface.context()
    }

    pub(in crate::gpu) fn output(&self) -> Output {
        self.output
    }

    /// Sets what the images are from the next `acquire` on.
    pub(in crate::gpu) fn set_output(&mut self, output: Output) {
        self.is_stale |= output != self.output;
        self.output = output;
    }

    /// Sets what the pictures hold at most, for an HDR screen.
    pub(in crate::gpu) fn set_content(&mut self, content: Content) {
        if self.content != Some(content) {
            self.content = Some(content);
            self.tell_screen();
        }
    }

    fn tell_screen(&self) {
        let extensions = &self.context().extensions;
        let (Some(loader), Some(content)) = (&extensions.hdr_metadata, &self.content) else {
            return;
        };
        if self.raw != vk::SwapchainKHR::null() && self.output.encoding.is_hdr() {
            // SAFETY: the swapchain is alive and belongs to this device.
            unsafe { loader.set_hdr_metadata(&[self.raw], &[content.metadata()]) };
        }
    }

    pub(in crate::gpu) fn image(&self, index: u32) -> &Image {
        &self.targets[index as usize].image
    }

    pub(in crate::gpu) fn drawn(&self, index: u32) -> vk::Semaphore {
        self.targets[index as usize].drawn.raw
    }

    /// Sets the window size, pixels.
    pub(in crate::gpu) fn resize(&mut self, size: [u32; 2]) {
        self.is_stale |= size != self.wanted;
        self.wanted = size;
    }

    /// Index of the next image, or `None` while the window has zero area or keeps changing size.
    ///
    /// `acquired` is signalled when the image is ready for rendering.
    pub(in crate::gpu) fn acquire(&mut self, acquired: vk::Semaphore) -> Result<Option<u32>> {
        for _ in 0..3 {
            if self.is_stale && !self.recreate()? {
                return Ok(None);
            }
            match self.try_acquire(acquired)? {
                Acquired::Image(index) => return Ok(Some(index)),
                Acquired::Retry => self.is_stale = true,
                Acquired::Nothing => return Ok(None),
            }
        }
        Ok(None)
    }

    fn try_acquire(&mut self, acquired: vk::Semaphore) -> Result<Acquired> {
        // Timeout of one second: the window may be hidden or the screen locked.
        let patience = 1_000_000_000;
        let planned = self.context().faults.at(Call::Acquire);
        // SAFETY: the semaphore is unsignalled and nothing waits for it.
        let got = planned.and_then(|()| unsafe {
            self.loader
                .acquire_next_image(self.raw, patience, acquired, vk::Fence::null())
        });
        match got {
            Ok((index, is_suboptimal)) => {
                // The image can still be used for this frame; the next frame recreates the swapchain.
                self.is_stale |= is_suboptimal;
                self.image(index).set_last_access(ImageAccess::Acquired);
                Ok(Acquired::Image(index))
            }
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => Ok(Acquired::Retry),
            Err(vk::Result::ERROR_SURFACE_LOST_KHR) => {
                self.replace_surface()?;
                Ok(Acquired::Retry)
            }
            Err(vk::Result::TIMEOUT | vk::Result::NOT_READY) => Ok(Acquired::Nothing),
            Err(result) => Err(result).during("acquire an image of the window"),
        }
    }

    /// Presents an image once rendering to it is done.
    pub(in crate::gpu) fn present(&mut self, index: u32) -> Result<()> {
        let (chains, indices, waits) = ([self.raw], [index], [self.drawn(index)]);
        let info = vk::PresentInfoKHR::default()
            .swapchains(&chains)
            .image_indices(&indices)
            .wait_semaphores(&waits);
        let queue = self.context().queue();
        // SAFETY: the image was acquired, and the submission that signals transitions it for presentation; no other thread uses the queue
        // meanwhile.
        let shown = unsafe { self.loader.queue_present(*queue, &info) };
        drop(queue);
        // A failed present still waits on its semaphore, so an injected fault takes effect after the call.
        match self.context().faults.at(Call::Present).and(shown) {
            Ok(is_suboptimal) => self.is_stale |= is_suboptimal,
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => self.is_stale = true,
            Err(vk::Result::ERROR_SURFACE_LOST_KHR) => self.replace_surface()?,
            Err(result) => return Err(result).during("present to the window"),
        }
        Ok(())
    }

    /// Recreates the swapchain; false while the window has zero area.
    fn recreate(&mut self) -> Result<bool> {
        let can = match self.surface.capabilities() {
            Err(vk::Result::ERROR_SURFACE_LOST_KHR) => {
                self.replace_surface()?;
                self.surface.capabilities()
            }
            other => other,
        }
        .during("ask what the window can do")?;
        let extent = extent(&can, self.wanted);
        if extent.width == 0 || extent.height == 0 {
            return Ok(false);
        }
        self.context().wait_idle()?;
        self.targets.clear();
        let old = std::mem::replace(&mut self.raw, vk::SwapchainKHR::null());
        let made = self.create(&can, extent, old);
        // SAFETY: the device is idle, so no image of the old swapchain is in use; null is ignored.
        unsafe { self.loader.destroy_swapchain(old, None) };
        self.raw = made?;
        self.tell_screen();
        self.targets = self.make_targets([extent.width, extent.height])?;
        self.is_stale = false;
        Ok(true)
    }

    fn create(
        &self,
        can: &vk::SurfaceCapabilitiesKHR,
        extent: vk::Extent2D,
        old: vk::SwapchainKHR,
    ) -> Result<vk::SwapchainKHR> {
        let most = if can.max_image_count == 0 {
            u32::MAX
        } else {
            can.max_image_count
        };
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(self.surface.handle())
            .min_image_count((can.min_image_count + 1).min(most))
            .image_format(self.output.format)
            .image_color_space(self.output.color_space)
            .image_extent(extent)
            .image_array_layers(1)
            .image_usage(vk::ImageUsageFlags::COLOR_ATTACHMENT)
            .pre_transform(can.current_transform)
            .composite_alpha(alpha(can.supported_composite_alpha))
            // FIFO is always supported and does not tear.
            .present_mode(vk::PresentModeKHR::FIFO)
            .clipped(true)
            .old_swapchain(old);
        // SAFETY: the surface is alive; this call retires the old swapchain.
        unsafe { self.loader.create_swapchain(&info, None) }.during("create the window's images")
    }

    fn make_targets(&self, size: [u32; 2]) -> Result<Vec<Target>> {
        // SAFETY: the swapchain was just created.
        let images = unsafe { self.loader.get_swapchain_images(self.raw) }
            .during("list the window's images")?;
        let context = self.context();
        images
            .into_iter()
            .map(|raw| {
                Ok(Target {
                    image: Image::of_swapchain(context, raw, self.output.format, size)?,
                    drawn: Semaphore::new(context)?,
                })
            })
            .collect()
    }

    fn replace_surface(&mut self) -> Result<()> {
        self.retire()?;
        self.surface.recreate()?;
        self.is_stale = true;
        Ok(())
    }

    fn retire(&mut self) -> Result<()> {
        let idle = self.context().wait_idle();
        self.targets.clear();
        let old = std::mem::replace(&mut self.raw, vk::SwapchainKHR::null());
        if self.context().freeing().is_some() {
            // SAFETY: the device is idle or lost; null is ignored.
            unsafe { self.loader.destroy_swapchain(old, None) };
        } else {
            self.surface.leave();
        }
        idle
    }
}

impl Drop for Swapchain {
    fn drop(&mut self) {
        // On a lost device there is nothing to wait for, so the error is ignored.
        let _ = self.retire();
    }
}

/// The extent required by the surface, or the window size clamped to the surface limits; 0 while the window has no area.
fn extent(can: &vk::SurfaceCapabilitiesKHR, wanted: [u32; 2]) -> vk::Extent2D {
    if can.current_extent.width != u32::MAX {
        return can.current_extent;
    }
    let (least, most) = (can.min_image_extent, can.max_image_extent);
    let within = |wanted: u32, least: u32, most: u32| match wanted {
        0 => 0,
        wanted => wanted.max(least).min(most),
    };
    vk::Extent2D {
        width: within(wanted[0], least.width, most.width),
        height: within(wanted[1], least.height, most.height),
    }
}

/// How the window's alpha is used: not at all if that is offered. Else any of what is offered: the alpha of every pixel is 1.
fn alpha(supported: vk::CompositeAlphaFlagsKHR) -> vk::CompositeAlphaFlagsKHR {
    use vk::CompositeAlphaFlagsKHR as Alpha;
    let order = [
        Alpha::OPAQUE,
        Alpha::PRE_MULTIPLIED,
        Alpha::POST_MULTIPLIED,
        Alpha::INHERIT,
    ];
    let first = order.into_iter().find(|flag| supported.contains(*flag));
    first.unwrap_or(Alpha::OPAQUE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surface(current: u32) -> vk::SurfaceCapabilitiesKHR {
        vk::SurfaceCapabilitiesKHR::default()
            .current_extent(vk::Extent2D {
                width: current,
                height: current,
            })
            .min_image_extent(vk::Extent2D {
                width: 8,
                height: 8,
            })
            .max_image_extent(vk::Extent2D {
                width: 100,
                height: 100,
            })
    }

    #[test]
    fn the_surface_rules_where_it_has_a_size() {
        let of = |current, wanted| {
            let e = extent(&surface(current), wanted);
            [e.width, e.height]
        };
        assert_eq!(of(7, [50, 60]), [7, 7]);
        assert_eq!(of(u32::MAX, [50, 600]), [50, 100]);
        assert_eq!(of(0, [50, 60]), [0, 0]);
        assert_eq!(of(u32::MAX, [0, 60]), [0, 60]);
        assert_eq!(of(u32::MAX, [1, 60]), [8, 60]);
    }

    #[test]
    fn only_an_alpha_that_is_offered_is_asked_for() {
        use vk::CompositeAlphaFlagsKHR as Alpha;
        assert_eq!(alpha(Alpha::OPAQUE | Alpha::INHERIT), Alpha::OPAQUE);
        assert_eq!(alpha(Alpha::INHERIT), Alpha::INHERIT);
        let multiplied = Alpha::POST_MULTIPLIED | Alpha::PRE_MULTIPLIED;
        assert_eq!(alpha(multiplied), Alpha::PRE_MULTIPLIED);
    }
}
