//! Work counters of passes: draws, minimum memory traffic, pipeline statistics.

use std::sync::Arc;

use ash::vk;

use crate::gpu::device::context::Context;
use crate::gpu::error::{During, Result};
use crate::gpu::memory::image::Image;

/// Work counters of one pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PassWork {
    /// Name of the pass.
    pub name: &'static str,
    /// Number of draws, dispatches or copies.
    pub draws: u64,
    /// Memory traffic.
    pub traffic: Traffic,
    /// Pipeline statistics, if the device supports them.
    pub statistics: Option<PipelineStatistics>,
}

/// Lower bound on the memory traffic of a pass, assuming every byte is fetched once.
///
/// Attachments count in full, and twice if they are loaded. A sampled image counts at most one texel per target pixel. Vertex,
/// index and storage buffers count once.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Pixels of the target, over all layers.
    pub pixels: u64,
    /// Bytes read.
    pub bytes_read: u64,
    /// Bytes written.
    pub bytes_written: u64,
}

/// Pipeline statistics counted by the device.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct PipelineStatistics {
    /// Vertices read.
    pub vertices: u64,
    /// Invocations of the vertex shader.
    pub vertex_invocations: u64,
    /// Triangles after clipping.
    pub clipped_primitives: u64,
    /// Invocations of the fragment shader.
    pub fragment_invocations: u64,
    /// Invocations of the compute shader.
    pub compute_invocations: u64,
}

/// The counters in bit order, which is the order of the query results.
const COUNTERS: [vk::QueryPipelineStatisticFlags; 5] = [
    vk::QueryPipelineStatisticFlags::INPUT_ASSEMBLY_VERTICES,
    vk::QueryPipelineStatisticFlags::VERTEX_SHADER_INVOCATIONS,
    vk::QueryPipelineStatisticFlags::CLIPPING_PRIMITIVES,
    vk::QueryPipelineStatisticFlags::FRAGMENT_SHADER_INVOCATIONS,
    vk::QueryPipelineStatisticFlags::COMPUTE_SHADER_INVOCATIONS,
];

const MAX_PASSES: u32 = 128;

impl Traffic {
    /// Zero traffic for a target with this many pixels.
    pub(in crate::gpu) fn new(pixels: u64) -> Self {
        Self {
            pixels,
            ..Self::default()
        }
    }

    /// Adds a sampled image.
    pub(in crate::gpu) fn sample(&mut self, image: &Image) {
        self.bytes_read += texels(image).min(self.pixels) * texel_bytes(image.format());
    }

    /// Adds an attachment or storage image; `keeps` if it is also loaded.
    pub(in crate::gpu) fn write(&mut self, image: &Image, keeps: bool) {
        let bytes = texels(image) * texel_bytes(image.format());
        self.bytes_written += bytes;
        self.bytes_read += if keeps { bytes } else { 0 };
    }

    /// Adds an attachment that is tested but not written.
    pub(in crate::gpu) fn test(&mut self, image: &Image) {
        self.bytes_read += texels(image) * texel_bytes(image.format());
    }
}

/// Texels of the first level.
pub(in crate::gpu) fn texels(image: &Image) -> u64 {
    let [width, height] = image.size().map(u64::from);
    width * height * u64::from(image.layers())
}

/// Bytes of a texel.
pub(in crate::gpu) fn texel_bytes(format: vk::Format) -> u64 {
    use vk::Format as F;
    match format {
        F::R8_UNORM | F::R8_UINT | F::R8_SNORM => 1,
        F::R16_SFLOAT | F::R16_UNORM | F::R16_UINT | F::R8G8_UNORM | F::R8G8_SNORM => 2,
        F::D16_UNORM => 2,
        F::R16G16B16A16_SFLOAT | F::R16G16B16A16_UNORM | F::R16G16B16A16_UINT => 8,
        F::R32G32_SFLOAT | F::R32G32_UINT => 8,
        F::R32G32B32A32_SFLOAT | F::R32G32B32A32_UINT => 16,
        // Display formats, packed formats, pairs of half floats, 32-bit numbers, depth.
        _ => 4,
    }
}

/// Work counters of the frame being recorded, and their queries.
pub(in crate::gpu) struct WorkLog {
    context: Arc<Context>,
    pool: vk::QueryPool,
    passes: Vec<PassWork>,
}

impl WorkLog {
    pub(in crate::gpu) fn new(context: &Arc<Context>) -> Result<Self> {
        let mut log = Self {
            context: context.clone(),
            pool: vk::QueryPool::null(),
            passes: Vec::new(),
        };
        if context.counts_work() {
            let flags = COUNTERS
                .into_iter()
                .fold(vk::QueryPipelineStatisticFlags::empty(), |a, b| a | b);
            let info = vk::QueryPoolCreateInfo::default()
                .query_type(vk::QueryType::PIPELINE_STATISTICS)
                .query_count(MAX_PASSES)
                .pipeline_statistics(flags);
            // SAFETY: the info has no pointers; the feature is enabled.
            log.pool = unsafe { context.raw().create_query_pool(&info, None) }
                .during("create pipeline statistics")?;
        }
        Ok(log)
    }

    pub(in crate::gpu) fn passes(&self) -> &[PassWork] {
        &self.passes
    }

    pub(in crate::gpu) fn reset(&mut self) {
        self.passes.clear();
        if self.pool != vk::QueryPool::null() {
            // SAFETY: hostQueryReset is enabled and no pending submission uses the pool.
            unsafe {
                self.context
                    .raw()
                    .reset_query_pool(self.pool, 0, MAX_PASSES)
            };
        }
    }

    /// Begins counting, outside a render pass; returns the index of the pass.
    pub(in crate::gpu) fn begin(
        &mut self,
        command: vk::CommandBuffer,
        name: &'static str,
    ) -> usize {
        self.passes.push(PassWork {
            name,
            draws: 0,
            traffic: Traffic::default(),
            statistics: None,
        });
        let index = self.passes.len() - 1;
        if let Some(query) = self.query(index) {
            let flags = vk::QueryControlFlags::empty();
            // SAFETY: the command buffer is recording and the query was reset.
            unsafe {
                self.context
                    .raw()
                    .cmd_begin_query(command, self.pool, query, flags)
            };
        }
        index
    }

    /// Ends counting, outside a render pass.
    pub(in crate::gpu) fn end(&self, command: vk::CommandBuffer, index: usize) {
        if let Some(query) = self.query(index) {
            // SAFETY: pairs with `begin`.
            unsafe { self.context.raw().cmd_end_query(command, self.pool, query) };
        }
    }

    pub(in crate::gpu) fn note(&mut self, index: usize, draws: u64, traffic: Traffic) {
        if let Some(pass) = self.passes.get_mut(index) {
            pass.draws = draws;
            pass.traffic = traffic;
        }
    }

    /// The query of a pass, or `None` if the pool is full.
    fn query(&self, index: usize) -> Option<u32> {
        let query = u32::try_from(index).ok()?;
        (self.pool != vk::QueryPool::null() && query < MAX_PASSES).then_some(query)
    }

    /// Reads the finished counters.
    pub(in crate::gpu) fn collect(&mut self) -> Result<()> {
        let counted = self.passes.len().min(MAX_PASSES as usize);
        if self.pool == vk::QueryPool::null() || counted == 0 {
            return Ok(());
        }
        let mut counts = vec![[0u64; COUNTERS.len()]; counted];
        // SAFETY: the submission was waited for, so all queries are available.
        unsafe {
            self.context.raw().get_query_pool_results(
                self.pool,
                0,
                &mut counts,
                vk::QueryResultFlags::TYPE_64,
            )
        }
        .during("read pipeline statistics")?;
        for (pass, count) in self.passes.iter_mut().zip(counts) {
            let [vertices, vertex, clipped, fragment, compute] = count;
            pass.statistics = Some(PipelineStatistics {
                vertices,
                vertex_invocations: vertex,
                clipped_primitives: clipped,
                fragment_invocations: fragment,
                compute_invocations: compute,
            });
        }
        Ok(())
    }
}

impl Drop for WorkLog {
    fn drop(&mut self) {
        if let Some(raw) = self.context.freeing() {
            // SAFETY: the recorder that owns this has waited for its work; a null handle is ignored.
            unsafe { raw.destroy_query_pool(self.pool, None) };
        }
    }
}
