//! Compute passes: one invocation for each texel of the images they write.

use ash::vk;

use crate::gpu::memory::image::Image;
use crate::gpu::pipeline::shader::BindingKind;
use crate::gpu::record::access::{self, ImageAccess};
use crate::gpu::record::pass::{Pass, sampled_accesses};
use crate::gpu::record::work::{Traffic, texels};

impl<'r> Pass<'r> {
    /// Writes every texel of the first level of an image; previous contents are undefined.
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

    /// Runs the compute shader once for each texel of the images that it writes: x, y and z of an invocation are column, row
    /// and layer. Work groups may reach beyond the edges; the shader checks.
    ///
    /// # Panics
    /// Without an image to write, or when the pipeline is not a compute pipeline: defects of this program.
    pub fn dispatch(mut self) {
        let Some(target) = self.stores.first().copied() else {
            panic!("pass {}: writes no image", self.name)
        };
        let Some(group) = self.pipeline.local_size else {
            panic!("pass {}: not a compute pipeline", self.name)
        };
        let [columns, rows] = target.size();
        let extent = [columns, rows, target.layers()];
        let groups: [u32; 3] = std::array::from_fn(|i| extent[i].div_ceil(group[i]));
        self.recorder.label(self.name);
        let mark = self.recorder.begin_timing(self.name);
        let stores = self.stores.iter().map(|i| (*i, ImageAccess::StorageWrite));
        self.recorder
            .transition(sampled_accesses(&self.reads).chain(stores));
        let command = self.recorder.command;
        let point = vk::PipelineBindPoint::COMPUTE;
        // SAFETY: the command buffer is recording outside of a rendering.
        unsafe {
            let raw = self.recorder.context.raw();
            raw.cmd_bind_pipeline(command, point, self.pipeline.raw());
        }
        self.flush();
        // SAFETY: the pipeline, its images and buffers were bound and brought to their layouts.
        unsafe {
            let raw = self.recorder.context.raw();
            raw.cmd_dispatch(command, groups[0], groups[1], groups[2]);
        }
        self.recorder.end_timing(&mark);
        self.recorder.unlabel();
        let traffic = self.stored_traffic(target);
        self.recorder.end_work(&mark, 1, || traffic);
        self.recorder.isolate(&mark);
    }

    fn stored_traffic(&self, target: &Image) -> Traffic {
        let mut traffic = Traffic::new(texels(target));
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
