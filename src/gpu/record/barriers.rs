//! Records barriers between accesses of images and buffers.

use arrayvec::ArrayVec;
use ash::vk;

use crate::gpu::memory::buffer::Buffer;
use crate::gpu::memory::image::{Image, is_depth};
use crate::gpu::record::access::{BufferAccess, ImageAccess};
use crate::gpu::record::recorder::Recorder;

type Barriers = ArrayVec<vk::ImageMemoryBarrier2<'static>, 32>;

impl Recorder {
    /// Clears a colour image to a constant.
    pub fn clear(&mut self, image: &Image, color: [f32; 4]) {
        self.transition([(image, ImageAccess::CopyTarget)].into_iter());
        let value = vk::ClearColorValue { float32: color };
        // SAFETY: the image is in this layout; the command buffer is recording outside of a rendering.
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

    /// Copies an image (all of its layers) to a mip level of another one that is as large.
    pub fn copy_to_level(&mut self, from: &Image, to: &Image, level: u32) {
        let uses = [
            (from, ImageAccess::CopySource),
            (to, ImageAccess::CopyTarget),
        ];
        self.transition(uses.into_iter());
        let layers = |image: &Image, mip_level| vk::ImageSubresourceLayers {
            aspect_mask: image.aspect(),
            mip_level,
            base_array_layer: 0,
            layer_count: image.layers(),
        };
        let [width, height] = from.size();
        let region = [vk::ImageCopy::default()
            .src_subresource(layers(from, 0))
            .dst_subresource(layers(to, level))
            .extent(vk::Extent3D {
                width,
                height,
                depth: 1,
            })];
        // SAFETY: both images are in these layouts; the command buffer is recording outside of a rendering.
        unsafe {
            self.context.raw().cmd_copy_image(
                self.command,
                from.raw(),
                vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
                to.raw(),
                vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                &region,
            );
        }
    }

    /// Transitions the attachments of the following passes now, so that no barriers separate these passes. Passes that do not
    /// read each other's images may then overlap on the device.
    pub fn prepare<'i>(&self, targets: impl Iterator<Item = &'i Image>) {
        let barriers = targets.filter_map(|image| {
            image.prepare(if is_depth(image.format()) {
                ImageAccess::DepthAttachment
            } else {
                ImageAccess::ColorAttachment
            })
        });
        self.image_barriers(&barriers.collect());
    }

    /// Transitions images to their next access with a single barrier command.
    pub(in crate::gpu) fn transition<'i>(
        &self,
        accesses: impl Iterator<Item = (&'i Image, ImageAccess)>,
    ) {
        let barriers = accesses.filter_map(|(image, next)| image.next(next));
        self.image_barriers(&barriers.collect());
    }

    /// Makes the next access of a buffer wait for the last one.
    pub(in crate::gpu) fn order(&self, buffer: &Buffer, next: BufferAccess) {
        let Some(barrier) = buffer.next(next) else {
            return;
        };
        let barriers = [vk::MemoryBarrier2::default()
            .src_stage_mask(barrier.src_stage)
            .src_access_mask(barrier.src_access)
            .dst_stage_mask(barrier.dst_stage)
            .dst_access_mask(barrier.dst_access)];
        self.barrier(&vk::DependencyInfo::default().memory_barriers(&barriers));
    }

    /// Sets every 32-bit word of a storage buffer.
    pub fn fill(&mut self, buffer: &Buffer, word: u32) {
        self.order(buffer, BufferAccess::CopyTarget);
        let raw = self.context.raw();
        // SAFETY: the buffer can be the target of copies; the command buffer is recording outside of a rendering.
        unsafe { raw.cmd_fill_buffer(self.command, buffer.raw(), 0, vk::WHOLE_SIZE, word) };
    }

    /// Writes `bytes` (a multiple of 4) to the start of a storage buffer when the commands before have run; for tables that change now and then.
    pub fn write(&mut self, buffer: &Buffer, bytes: &[u8]) {
        /// The most that one command may hold (VUID-vkCmdUpdateBuffer-dataSize-00037).
        const MOST: usize = 65_536;
        assert!(bytes.len() as u64 <= buffer.size() && bytes.len().is_multiple_of(4));
        self.order(buffer, BufferAccess::CopyTarget);
        let raw = self.context.raw();
        for (i, part) in bytes.chunks(MOST).enumerate() {
            let offset = (i * MOST) as u64;
            // SAFETY: the part lies within the buffer, which can be the target of copies; the command buffer is recording outside of a rendering.
            unsafe { raw.cmd_update_buffer(self.command, buffer.raw(), offset, part) };
        }
    }

    fn image_barriers(&self, barriers: &Barriers) {
        if !barriers.is_empty() {
            self.barrier(&vk::DependencyInfo::default().image_memory_barriers(barriers));
        }
    }

    fn barrier(&self, info: &vk::DependencyInfo<'_>) {
        let raw = self.context.raw();
        // SAFETY: the command buffer is recording outside of a rendering; the images are alive.
        unsafe { raw.cmd_pipeline_barrier2(self.command, info) };
    }
}
