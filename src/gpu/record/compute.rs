//! Compute: a pipeline of one stage, and a pass that runs it once for each texel of the images it stores to.

use ash::vk;

use crate::gpu::device::context::Context;
use crate::gpu::error::{During, Result};
use crate::gpu::memory::image::Image;
use crate::gpu::pipeline::shader::BindingKind;
use crate::gpu::record::access::{self, Use};
use crate::gpu::record::pass::{Pass, sampled_uses};
use crate::gpu::record::work::{Traffic, texels};

/// Compiles the pipeline.
pub(in crate::gpu) fn create(
    context: &Context,
    layout: vk::PipelineLayout,
    stage: vk::PipelineShaderStageCreateInfo<'_>,
) -> Result<vk::Pipeline> {
    let info = vk::ComputePipelineCreateInfo::default()
        .stage(stage)
        .layout(layout);
    // SAFETY: what `info` points to is borrowed by `stage`; the layout is alive.
    let made = unsafe {
        context
            .raw()
            .create_compute_pipelines(context.pipeline_cache(), &[info], None)
    };
    made.map(|p| p[0])
        .map_err(|(_, result)| result)
        .during("compile a compute pipeline")
}

impl<'r> Pass<'r> {
    /// Writes to the first level of an image; every texel is written, so that nobody cares what was there.
    pub fn store(mut self, name: &str, image: &'r Image) -> Self {
        self.bind_view(
            name,
            BindingKind::StorageImage,
            vk::DescriptorImageInfo {
                sampler: vk::Sampler::null(),
                image_view: image.attachment_view(),
                image_layout: access::layout(Use::StorageWrite),
            },
        );
        self.stores.push(image);
        self
    }

    /// Runs the compute shader once for each texel of the images that are stored to: x, y and z of an invocation are
    /// column, row and layer. It may run beyond the edges; the shader looks.
    ///
    /// # Panics
    /// When nothing is stored to, or the pipeline is none of compute: a fault of this program.
    pub fn dispatch(mut self) {
        let Some(target) = self.stores.first().copied() else {
            panic!("pass {}: stores to nothing", self.name)
        };
        let Some(group) = self.pipeline.local_size else {
            panic!("pass {}: no compute pipeline", self.name)
        };
        let [columns, rows] = target.size();
        let extent = [columns, rows, target.layers()];
        let groups: [u32; 3] = std::array::from_fn(|i| extent[i].div_ceil(group[i]));
        self.recorder.label(self.name);
        let mark = self.recorder.begin_timing(self.name);
        let stores = self.stores.iter().map(|i| (*i, Use::StorageWrite));
        self.recorder
            .transition(sampled_uses(&self.reads).chain(stores));
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
