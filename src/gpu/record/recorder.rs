//! Records commands, submits them, waits for them.

use std::sync::Arc;

use ash::vk;
use bytemuck::Pod;

use crate::gpu::device::context::Context;
use crate::gpu::device::fault::Call;
use crate::gpu::error::{During, GpuError, Result};
use crate::gpu::memory::buffer::{Buffer, BufferKind};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::record::pass::Pass;
use crate::gpu::record::timings::{PassTime, Queries, Stopwatch, Timing, Timings};
use crate::gpu::record::work::{PassWork, Traffic, WorkLog};

/// Bytes of uniform blocks a recorder can hold between `begin` and `finish`.
const UNIFORM_BYTES: u64 = 1 << 16;
/// Descriptor sets a recorder can use without push descriptors.
const POOL_SETS: u32 = 4096;

/// One command buffer with what it needs between `begin` and `finish`.
pub struct Recorder {
    pub(in crate::gpu) context: Arc<Context>,
    pub(in crate::gpu) command: vk::CommandBuffer,
    command_pool: vk::CommandPool,
    descriptor_pool: vk::DescriptorPool,
    fence: vk::Fence,
    is_pending: bool,
    acquired: Option<vk::Semaphore>,
    uniforms: Buffer,
    uniform_end: u64,
    kept: Vec<Buffer>,
    timing: Timing,
    queries: Queries,
    timings: Timings,
    work: Option<WorkLog>,
    fault: Option<GpuError>,
}

impl Recorder {
    /// Makes a recorder.
    ///
    /// # Errors
    /// When the driver has no memory left.
    pub fn new(context: &Arc<Context>, timing: Timing) -> Result<Self> {
        let pool_info = vk::CommandPoolCreateInfo::default()
            .queue_family_index(context.queue_family)
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
        let uniforms = Buffer::new(context, "uniforms", BufferKind::Uniform, UNIFORM_BYTES)?;
        let queries = Queries::new(context)?;
        let raw = context.raw();
        // SAFETY: the info has no pointers.
        let command_pool =
            unsafe { raw.create_command_pool(&pool_info, None) }.during("create a command pool")?;
        let mut recorder = Self {
            context: context.clone(),
            command: vk::CommandBuffer::null(),
            command_pool,
            descriptor_pool: vk::DescriptorPool::null(),
            fence: vk::Fence::null(),
            is_pending: false,
            acquired: None,
            uniforms,
            uniform_end: 0,
            kept: Vec::new(),
            timing,
            queries,
            timings: Timings::default(),
            work: (timing == Timing::Work)
                .then(|| WorkLog::new(context))
                .transpose()?,
            fault: None,
        };
        let allocate = vk::CommandBufferAllocateInfo::default()
            .command_pool(command_pool)
            .command_buffer_count(1);
        // SAFETY: the pool was just made.
        recorder.command = unsafe { raw.allocate_command_buffers(&allocate) }
            .during("allocate a command buffer")?[0];
        // SAFETY: the info has no pointers.
        recorder.fence = unsafe { raw.create_fence(&vk::FenceCreateInfo::default(), None) }
            .during("create a fence")?;
        if context.push_descriptor.is_none() {
            recorder.descriptor_pool = recorder.create_descriptor_pool()?;
        }
        Ok(recorder)
    }

    fn create_descriptor_pool(&self) -> Result<vk::DescriptorPool> {
        let size = |ty, each| vk::DescriptorPoolSize {
            ty,
            descriptor_count: each * POOL_SETS,
        };
        let sizes = [
            size(vk::DescriptorType::COMBINED_IMAGE_SAMPLER, 8),
            size(vk::DescriptorType::UNIFORM_BUFFER, 2),
            size(vk::DescriptorType::STORAGE_BUFFER, 2),
            size(vk::DescriptorType::STORAGE_IMAGE, 1),
        ];
        let info = vk::DescriptorPoolCreateInfo::default()
            .max_sets(POOL_SETS)
            .pool_sizes(&sizes);
        // SAFETY: `sizes` outlives the call.
        unsafe { self.context.raw().create_descriptor_pool(&info, None) }
            .during("create a descriptor pool")
    }

    /// Starts a frame, after the one that was submitted before is done.
    ///
    /// # Errors
    /// When the driver has no memory left.
    pub fn begin(&mut self) -> Result<()> {
        self.wait()?;
        self.uniform_end = 0;
        self.timings.clear();
        self.queries.reset();
        if let Some(work) = &mut self.work {
            work.reset();
        }
        if self.descriptor_pool != vk::DescriptorPool::null() {
            let flags = vk::DescriptorPoolResetFlags::empty();
            // SAFETY: no submission that uses its sets is pending.
            unsafe {
                self.context
                    .raw()
                    .reset_descriptor_pool(self.descriptor_pool, flags)
            }
            .during("reset the descriptor pool")?;
        }
        self.begin_commands()
    }

    fn begin_commands(&self) -> Result<()> {
        let info = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        let begin = "begin a command buffer";
        self.context.faults.at(Call::Record).during(begin)?;
        // SAFETY: the command buffer is not pending.
        unsafe { self.context.raw().begin_command_buffer(self.command, &info) }.during(begin)
    }

    /// Submits what was recorded and waits until it is done.
    ///
    /// # Errors
    /// When the device is lost, or a pass could not be recorded.
    pub fn finish(&mut self) -> Result<()> {
        let submitted = self.submit(None);
        let done = self.wait();
        submitted.and(done)
    }

    /// Forgets what was recorded since [`Self::begin`], because something that it uses could not be made. Images that outlive
    /// it must not have been recorded.
    ///
    /// # Errors
    /// When the driver has no memory left.
    pub fn abandon(&mut self) -> Result<()> {
        let flags = vk::CommandBufferResetFlags::empty();
        // SAFETY: the command buffer was not submitted, and its pool lets it be reset.
        unsafe { self.context.raw().reset_command_buffer(self.command, flags) }
            .during("reset a command buffer")?;
        self.wait()
    }

    /// Submits what was recorded, to run while the CPU goes on; `signal` is signalled at its end.
    pub(in crate::gpu) fn submit(&mut self, signal: Option<vk::Semaphore>) -> Result<()> {
        let raw = self.context.raw();
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(self.command)];
        let wait = self.acquired.take().map(|semaphore| {
            vk::SemaphoreSubmitInfo::default()
                .semaphore(semaphore)
                .stage_mask(vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT)
        });
        let signal = signal.map(|semaphore| {
            vk::SemaphoreSubmitInfo::default()
                .semaphore(semaphore)
                .stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
        });
        let submit = [vk::SubmitInfo2::default()
            .command_buffer_infos(&commands)
            .wait_semaphore_infos(wait.as_slice())
            .signal_semaphore_infos(signal.as_slice())];
        // SAFETY: the command buffer is recording; the fence is unsignalled and used by this submission alone.
        unsafe {
            raw.end_command_buffer(self.command)
                .during("end a command buffer")?;
            self.context.faults.at(Call::Submit).during("submit work")?;
            raw.queue_submit2(self.context.queue, &submit, self.fence)
                .during("submit work")?;
        }
        self.is_pending = true;
        Ok(())
    }

    /// Waits until what was submitted is done, and lets go of what it used.
    ///
    /// # Errors
    /// When the device is lost, or a pass could not be recorded.
    pub fn wait(&mut self) -> Result<()> {
        let waited = self.wait_for_fence();
        if waited.is_err() {
            // Memory may have been out for the waiting only: what the work uses must outlive it all the same.
            // SAFETY: the queue is used by one thread at a time. A lost device has nothing to wait for.
            let _ = unsafe { self.context.raw().device_wait_idle() };
        }
        self.kept.clear();
        if let Some(fault) = self.fault.take() {
            return Err(fault);
        }
        if !waited? {
            return Ok(());
        }
        if let Some(work) = &mut self.work {
            work.collect()?;
        }
        match self.timing {
            Timing::Timestamps => self.queries.collect(&mut self.timings),
            _ => Ok(()),
        }
    }

    /// Whether there was anything to wait for.
    fn wait_for_fence(&mut self) -> Result<bool> {
        if !std::mem::take(&mut self.is_pending) {
            return Ok(false);
        }
        let raw = self.context.raw();
        let planned = self.context.faults.at(Call::Wait);
        planned.during("wait for the device")?;
        // SAFETY: the fence belongs to the one pending submission.
        unsafe {
            raw.wait_for_fences(&[self.fence], true, u64::MAX)
                .during("wait for the device")?;
            raw.reset_fences(&[self.fence]).during("reset a fence")?;
        }
        Ok(true)
    }

    /// The next submission waits for this semaphore before it draws to an acquired image.
    pub(in crate::gpu) fn wait_for(&mut self, acquired: vk::Semaphore) {
        self.acquired = Some(acquired);
    }

    /// Times passes differently from the next frame on ([`Timing::Work`] needs a recorder that was made for it).
    pub fn set_timing(&mut self, timing: Timing) {
        self.timing = timing;
    }

    /// Times of the last frame that was waited for; empty with [`Timing::Off`].
    pub fn timings(&self) -> &Timings {
        &self.timings
    }

    /// What the passes of the last finished frame did; empty but with [`Timing::Work`].
    pub fn work(&self) -> &[PassWork] {
        self.work.as_ref().map_or(&[], WorkLog::passes)
    }

    /// The context it records for.
    pub fn context(&self) -> &Arc<Context> {
        &self.context
    }

    /// Starts a pass: bind by the names the shaders declare, then draw.
    pub fn pass<'r>(&'r mut self, name: &'static str, pipeline: &'r Pipeline) -> Pass<'r> {
        Pass::new(self, name, pipeline)
    }

    /// Holds a buffer until the work is done.
    pub(in crate::gpu) fn keep(&mut self, buffer: Buffer) {
        self.kept.push(buffer);
    }

    /// Copies a block into the uniform buffer; gives its place.
    pub(in crate::gpu) fn uniform<T: Pod>(&mut self, value: &T) -> vk::DescriptorBufferInfo {
        let bytes = bytemuck::bytes_of(value);
        let align = self
            .context
            .limits
            .min_uniform_buffer_offset_alignment
            .max(16);
        let offset = self.uniform_end.next_multiple_of(align);
        let end = offset + bytes.len() as u64;
        assert!(
            end <= UNIFORM_BYTES,
            "uniform blocks of one frame exceed {UNIFORM_BYTES} bytes"
        );
        self.uniforms.bytes_mut()[offset as usize..end as usize].copy_from_slice(bytes);
        self.uniform_end = end;
        vk::DescriptorBufferInfo {
            buffer: self.uniforms.raw(),
            offset,
            range: bytes.len() as u64,
        }
    }

    /// A descriptor set, on devices without push descriptors.
    pub(in crate::gpu) fn descriptor_set(
        &mut self,
        pipeline: &Pipeline,
    ) -> Option<vk::DescriptorSet> {
        let layouts = [pipeline.set_layout()];
        let info = vk::DescriptorSetAllocateInfo::default()
            .descriptor_pool(self.descriptor_pool)
            .set_layouts(&layouts);
        // SAFETY: the pool is alive and not used by another thread.
        let made = unsafe { self.context.raw().allocate_descriptor_sets(&info) }
            .during("allocate a descriptor set");
        match made {
            Ok(sets) => sets.first().copied(),
            Err(fault) => {
                self.fault.get_or_insert(fault);
                None
            }
        }
    }

    pub(in crate::gpu) fn begin_timing(&mut self, name: &'static str) -> Mark {
        match self.timing {
            Timing::Off => Mark::None,
            Timing::Timestamps => self
                .queries
                .begin(self.command, name)
                .map_or(Mark::None, Mark::Query),
            Timing::Isolated => Mark::Wall(name),
            Timing::Work => match &mut self.work {
                Some(work) => Mark::Work(work.begin(self.command, name)),
                None => Mark::None,
            },
        }
    }

    /// The part of a timing that must be written inside the rendering, for software drivers to attribute it.
    pub(in crate::gpu) fn end_timing(&self, mark: &Mark) {
        if let Mark::Query(index) = mark {
            self.queries.end(self.command, *index);
        }
    }

    /// With [`Timing::Work`], notes what the pass that was just recorded is made of, and what it touches.
    pub(in crate::gpu) fn end_work(
        &mut self,
        mark: &Mark,
        draws: u64,
        traffic: impl FnOnce() -> Traffic,
    ) {
        if let (Mark::Work(index), Some(work)) = (mark, &mut self.work) {
            work.end(self.command, *index);
            work.note(*index, draws, traffic());
        }
    }

    /// With [`Timing::Isolated`], runs the pass that was just recorded and starts anew.
    pub(in crate::gpu) fn isolate(&mut self, mark: &Mark) {
        let Mark::Wall(name) = mark else { return };
        let start = Stopwatch::start();
        let done = self.submit(None).and_then(|()| self.wait_for_fence());
        let (ms, cpu_ms) = start.elapsed_ms();
        self.timings.push(PassTime { name, ms, cpu_ms });
        if let Err(fault) = done.and_then(|_| self.begin_commands()) {
            self.fault.get_or_insert(fault);
        }
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        let raw = self.context.raw();
        // SAFETY: work was waited for in `finish` (or lost with the device); null handles are ignored.
        unsafe {
            let _ = raw.device_wait_idle();
            raw.destroy_fence(self.fence, None);
            raw.destroy_descriptor_pool(self.descriptor_pool, None);
            raw.destroy_command_pool(self.command_pool, None);
        }
    }
}

/// Where a pass notes its time.
pub(in crate::gpu) enum Mark {
    None,
    Query(u32),
    Wall(&'static str),
    Work(usize),
}
