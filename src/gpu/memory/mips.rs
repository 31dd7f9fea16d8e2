//! Mip levels: by repeated halving, or copied from images of their own.

use ash::vk;

use crate::gpu::memory::image::Image;
use crate::gpu::record::access::ImageAccess;
use crate::gpu::record::recorder::Recorder;
use crate::gpu::record::work::{Traffic, texel_bytes, texels};

impl Recorder {
    /// Generates the mip chain of an image from its first level: each texel is the mean of four.
    pub fn mipmap(&mut self, name: &'static str, image: &Image) {
        self.label(name);
        let mark = self.begin_timing(name);
        self.transition([(image, ImageAccess::CopyTarget)].into_iter());
        for level in 1..image.levels() {
            self.level_transition(
                image,
                level - 1,
                ImageAccess::CopyTarget,
                ImageAccess::CopySource,
            );
            self.blit(image, level);
        }
        self.level_transition(
            image,
            image.levels() - 1,
            ImageAccess::CopyTarget,
            ImageAccess::CopySource,
        );
        image.set_last_access(ImageAccess::CopySource);
        self.end_timing(&mark);
        self.unlabel();
        self.end_work(&mark, u64::from(image.levels() - 1), || mip_traffic(image));
        self.isolate(&mark);
    }

    /// Copies an image of one level to a level of another with as many layers. The other levels are kept.
    pub fn copy_level(&mut self, name: &'static str, from: &Image, to: &Image, level: u32) {
        self.label(name);
        let mark = self.begin_timing(name);
        let accesses = [
            (from, ImageAccess::CopySource),
            (to, ImageAccess::CopyTarget),
        ];
        self.transition(accesses.into_iter());
        let layers = |mip_level| vk::ImageSubresourceLayers {
            aspect_mask: from.aspect(),
            mip_level,
            base_array_layer: 0,
            layer_count: from.layers(),
        };
        let [width, height] = from.size();
        let region = [vk::ImageCopy::default()
            .src_subresource(layers(0))
            .dst_subresource(layers(level))
            .extent(vk::Extent3D {
                width,
                height,
                depth: 1,
            })];
        // SAFETY: `transition` brought both images to these layouts.
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
        self.end_timing(&mark);
        self.unlabel();
        let bytes = texels(from) * texel_bytes(from.format());
        let traffic = Traffic {
            bytes_read: bytes,
            bytes_written: bytes,
            ..Traffic::new(texels(from))
        };
        self.end_work(&mark, 1, || traffic);
        self.isolate(&mark);
    }

    /// Downsamples level `level - 1` (copy source) into `level` (copy target).
    fn blit(&self, image: &Image, level: u32) {
        let layers = |mip_level| vk::ImageSubresourceLayers {
            aspect_mask: image.aspect(),
            mip_level,
            base_array_layer: 0,
            layer_count: image.layers(),
        };
        let corner = |level: u32| {
            let edge = |size: u32| (size >> level).max(1).cast_signed();
            let [x, y] = image.size().map(edge);
            [vk::Offset3D::default(), vk::Offset3D { x, y, z: 1 }]
        };
        let region = [vk::ImageBlit::default()
            .src_subresource(layers(level - 1))
            .src_offsets(corner(level - 1))
            .dst_subresource(layers(level))
            .dst_offsets(corner(level))];
        // SAFETY: both levels are in these layouts.
        unsafe {
            self.context.raw().cmd_blit_image(
                self.command,
                image.raw(),
                vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
                image.raw(),
                vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                &region,
                vk::Filter::LINEAR,
            );
        }
    }
}

/// All levels but the last are read, all but the first are written.
fn mip_traffic(image: &Image) -> Traffic {
    let bytes = |level: u32| {
        let [width, height] = image.size().map(|edge| u64::from((edge >> level).max(1)));
        width * height * u64::from(image.layers()) * texel_bytes(image.format())
    };
    let last = image.levels().saturating_sub(1);
    Traffic {
        bytes_read: (0..last).map(bytes).sum(),
        bytes_written: (1..=last).map(bytes).sum(),
        ..Traffic::new(texels(image))
    }
}
