//! Bringing images to their next use: the barriers between passes.

use arrayvec::ArrayVec;
use ash::vk;

use crate::gpu::memory::image::{Image, is_depth};
use crate::gpu::record::access::Use;
use crate::gpu::record::recorder::Recorder;

type Barriers = ArrayVec<vk::ImageMemoryBarrier2<'static>, 32>;

impl Recorder {
    /// Fills a colour image with a constant.
    pub fn clear(&mut self, image: &Image, color: [f32; 4]) {
        self.transition([(image, Use::CopyTarget)].into_iter());
        let value = vk::ClearColorValue { float32: color };
        // SAFETY: the image was brought to this layout; the command buffer is recording outside of a rendering.
        unsafe {
            self.context.raw().cmd_clear_color_image(
                self.command,
                image.raw(),
                vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                &value,
                &[image.whole()],
            );
        }
    }

    /// Brings what later passes draw to into place now, so that no barrier stands between them: passes that do not read each
    /// other's images may then run at the same time.
    pub fn prepare<'i>(&self, targets: impl Iterator<Item = &'i Image>) {
        let barriers = targets.filter_map(|image| {
            image.prepare(if is_depth(image.format()) {
                Use::DepthAttachment
            } else {
                Use::ColorAttachment
            })
        });
        self.barrier(&barriers.collect());
    }

    /// Brings images to their next use with one barrier command.
    pub(in crate::gpu) fn transition<'i>(&self, uses: impl Iterator<Item = (&'i Image, Use)>) {
        let barriers = uses.filter_map(|(image, next)| image.next(next));
        self.barrier(&barriers.collect());
    }

    fn barrier(&self, barriers: &Barriers) {
        if barriers.is_empty() {
            return;
        }
        let info = vk::DependencyInfo::default().image_memory_barriers(barriers);
        // SAFETY: the command buffer is recording outside of a rendering; the images are alive.
        unsafe {
            self.context
                .raw()
                .cmd_pipeline_barrier2(self.command, &info)
        };
    }
}
