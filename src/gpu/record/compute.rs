//! Compute passes: one invocation per texel of the written images, or per element of a buffer.

use ash::vk;

use crate::gpu::memory::image::Image;
use crate::gpu::pipeline::shader::BindingKind;
use crate::gpu::record::access::{self, ImageAccess};
use crate::gpu::record::pass::{Pass, sampled_accesses};
use crate::gpu::record::work::Traffic;

impl<'r> Pass<'r> {
    /// Binds a storage image of which the pass writes texels of the first level; the others are kept.
    pub fn store(mut self, name: &str, image: &'r Image) -> Self {
        self.bind_view(
            name,
            BindingKind::StorageImage,
            vk::DescriptorImageInfo {
                sampler: vk::Sampler::null(),
                image_view: image.attachment_view(),
                image_layout: access::layout(ImageAccess::StorageWrite),
            },
        );
        self.stores.push(image);
        self
    }

    /// Dispatches one invocation per texel of the written images; x, y and z of the invocation are column, row and layer. Work
    /// groups may extend beyond the edges, which the shader has to check.
    ///
    /// # Panics
    /// When no image is written or the pipeline is not a compute pipeline. These are bugs in the program.
    pub fn dispatch(self) {
        let Some(target) = self.stores.first().copied() else {
            panic!("pass {}: writes no image", self.name)
        };
        let [columns, rows] = target.size();
        self.dispatch_over([columns, rows, target.layers()]);
    }

    /// Dispatches at least `extent` invocations. Work groups may extend beyond it, which the shader has to check.
    ///
    /// # Panics
    /// When the pipeline is not a compute pipeline. This is a bug in the program.
    pub fn dispatch_over(mut self, extent: [u32; 3]) {
        let Some(group) = self.pipeline.made.local_size else {
            panic!("pass {}: not a compute pipeline", self.name)
        };
        let groups: [u32; 3] = std::array::from_fn(|i| extent[i].div_ceil(group[i]));
        self.recorder.label(self.name);
        let mark = self.recorder.begin_timing(self.name);
        let stores = self.stores.iter().map(|i| (*i, ImageAccess::StorageWrite));
        self.recorder
            .transition(sampled_accesses(&self.reads).chain(stores));
        self.order_buffers();
        let command = self.recorder.command;
        let point = vk::PipelineBindPoint::COMPUTE;
        // SAFETY: the command buffer is recording outside of a rendering.
        unsafe {
            let raw = self.recorder.context.raw();
            raw.cmd_bind_pipeline(command, point, self.pipeline.raw());
        }
        self.flush();
        // SAFETY: pipeline, images and buffers are bound, and the images are in their layouts.
        unsafe {
            let raw = self.recorder.context.raw();
            raw.cmd_dispatch(command, groups[0], groups[1], groups[2]);
        }
        self.recorder.end_timing(&mark);
        self.recorder.unlabel();
        let invocations = extent.iter().map(|n| u64::from(*n)).product();
        let traffic = self.stored_traffic(invocations);
        self.recorder.end_work(&mark, 1, || traffic);
        self.recorder.isolate(&mark);
    }

    fn stored_traffic(&self, invocations: u64) -> Traffic {
        let mut traffic = Traffic::new(invocations);
        traffic.bytes_read += self.buffer_bytes;
        for image in &self.reads {
            traffic.sample(image);
        }
        for image in &self.stores {
            traffic.write(image, false);
        }
        traffic
    }
}
