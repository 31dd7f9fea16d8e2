//! The recorder: records commands, submits them and waits for completion.

use std::any::Any;
use std::sync::Arc;

use ash::vk;
use bytemuck::Pod;

use crate::gpu::device::context::Context;
use crate::gpu::device::fault::Call;
use crate::gpu::error::{During, GpuError, Result};
use crate::gpu::memory::buffer::{Buffer, BufferKind};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::record::descriptors::DescriptorPools;
use crate::gpu::record::pass::Pass;
use crate::gpu::record::timings::{PassTime, Queries, Stopwatch, Timing, Timings};
use crate::gpu::record::work::{PassWork, Traffic, WorkLog};

/// Size of the buffer for the uniform blocks of one frame, bytes.
const UNIFORM_BYTES: u64 = 1 << 18;

/// A command buffer and the resources it needs between `begin` and `finish`.
pub struct Recorder {
    pub(in crate::gpu) context: Arc<Context>,
    pub(in crate::gpu) command: vk::CommandBuffer,
    command_pool: vk::CommandPool,
    descriptors: DescriptorPools,
    fence: vk::Fence,
    is_pending: bool,
    acquired: Option<vk::Semaphore>,
    uniforms: Buffer,
    uniform_end: u64,
    /// What the work uses, of any kind.
    kept: Vec<Box<dyn Any + Send>>,
    timing: Timing,
    queries: Queries,
    timings: Timings,
    work: Option<WorkLog>,
    fault: Option<GpuError>,
}

impl Recorder {
    /// Creates a recorder.
    ///
    /// # Errors
    /// When memory is exhausted.
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
            descriptors: DescriptorPools::new(context),
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
        // SAFETY: the pool was just created.
        recorder.command = unsafe { raw.allocate_command_buffers(&allocate) }
            .during("allocate a command buffer")?[0];
        // SAFETY: the info has no pointers.
        recorder.fence = unsafe { raw.create_fence(&vk::FenceCreateInfo::default(), None) }
            .during("create a fence")?;
        Ok(recorder)
    }

    /// Begins a frame, after waiting for the previous submission.
    ///
    /// # Errors
    /// When memory is exhausted or the device is lost.
    pub fn begin(&mut self) -> Result<()> {
        self.wait()?;
        self.uniform_end = 0;
        self.timings.clear();
        self.queries.reset();
        if let Some(work) = &mut self.work {
            work.reset();
        }
        self.descriptors.reset()?;
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

    /// Submits the recorded work and waits for completion.
    ///
    /// # Errors
    /// When the device is lost or a pass could not be recorded.
    pub fn finish(&mut self) -> Result<()> {
        let submitted = self.submit(None);
        let done = self.wait();
        submitted.and(done)
    }

    /// Discards everything recorded since [`Self::begin`], for when a resource it needs could not be created. It must not
    /// involve images that outlive the recording, because their tracked access would be wrong.
    ///
    /// # Errors
    /// When the driver is out of memory.
    pub fn abandon(&mut self) -> Result<()> {
        let flags = vk::CommandBufferResetFlags::empty();
        // SAFETY: the command buffer was not submitted, and its pool allows resetting it.
        unsafe { self.context.raw().reset_command_buffer(self.command, flags) }
            .during("reset a command buffer")?;
        self.wait()
    }

    /// Submits the recorded work without waiting; `signal` is signalled on completion.
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
        // SAFETY: the command buffer is recording; the fence is unsignalled and used by this submission alone; no other thread uses the
        // queue meanwhile.
        unsafe {
            raw.end_command_buffer(self.command)
                .during("end a command buffer")?;
            self.context.faults.at(Call::Submit).during("submit work")?;
            let queue = self.context.queue();
            raw.queue_submit2(*queue, &submit, self.fence)
                .during("submit work")?;
        }
        self.is_pending = true;
        Ok(())
    }

    /// Waits for the submitted work and releases its resources.
    ///
    /// # Errors
    /// When the device is lost or a pass could not be recorded.
    pub fn wait(&mut self) -> Result<()> {
        let waited = self.wait_for_fence();
        if waited.is_err() {
            // The wait itself may have run out of memory, but the resources must still outlive the work.
            self.context.settle();
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

    /// Whether submitted work has not been waited for.
    #[cfg(feature = "window")]
    pub(in crate::gpu) fn is_pending(&self) -> bool {
        self.is_pending
    }

    /// Waits for the fence; returns whether work was pending.
    fn wait_for_fence(&mut self) -> Result<bool> {
        if !std::mem::take(&mut self.is_pending) {
            return Ok(false);
        }
        let raw = self.context.raw();
        let planned = self.context.faults.at(Call::Wait);
        planned.map_err(|result| self.context.unanswered(result, self.context.longest_wait()))?;
        // SAFETY: the fence belongs to the one pending submission.
        unsafe {
            let longest = self.context.longest_wait();
            raw.wait_for_fences(&[self.fence], true, longest.as_nanos() as u64)
                .map_err(|result| self.context.unanswered(result, longest))?;
            raw.reset_fences(&[self.fence]).during("reset a fence")?;
        }
        Ok(true)
    }

    /// Makes the next submission wait for this semaphore before it writes colour attachments.
    #[cfg(feature = "window")]
    pub(in crate::gpu) fn wait_for(&mut self, acquired: vk::Semaphore) {
        self.acquired = Some(acquired);
    }

    /// Sets the timing mode from the next frame on. [`Timing::Work`] requires a recorder created with it.
    pub fn set_timing(&mut self, timing: Timing) {
        self.timing = timing;
    }

    /// Pass times of the last finished frame; empty with [`Timing::Off`].
    pub fn timings(&self) -> &Timings {
        &self.timings
    }

    /// Work counters of the last finished frame; empty without [`Timing::Work`].
    pub fn work(&self) -> &[PassWork] {
        self.work.as_ref().map_or(&[], WorkLog::passes)
    }

    /// The context of the recorder.
    pub fn context(&self) -> &Arc<Context> {
        &self.context
    }

    /// Starts a pass. Resources are bound by their names in the shaders.
    pub fn pass<'r>(&'r mut self, name: &'static str, pipeline: &'r Pipeline) -> Pass<'r> {
        Pass::new(self, name, pipeline)
    }

    /// Keeps what this work or earlier work uses alive until it is done: buffers of copies, passes that others take the place of.
    pub fn keep(&mut self, used: impl Any + Send) {
        self.kept.push(Box::new(used));
    }

    /// Copies a block into the uniform buffer and returns its range.
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

    /// A descriptor set for this frame, on devices without push descriptors. On failure, `finish` reports the error.
    pub(in crate::gpu) fn descriptor_set(
        &mut self,
        pipeline: &Pipeline,
    ) -> Option<vk::DescriptorSet> {
        let set = self.descriptors.allocate(pipeline.set_layout());
        set.map_err(|fault| self.fault.get_or_insert(fault)).ok()
    }

    /// Begins a debug label, shown in captures and validation messages.
    pub(in crate::gpu) fn label(&self, name: &str) {
        let Some(debug) = &self.context.extensions.debug else {
            return;
        };
        let mut text = [0u8; 64];
        let length = name.len().min(text.len() - 1);
        text[..length].copy_from_slice(&name.as_bytes()[..length]);
        let Ok(text) = std::ffi::CStr::from_bytes_until_nul(&text) else {
            return;
        };
        let info = vk::DebugUtilsLabelEXT::default().label_name(text);
        // SAFETY: the command buffer is recording.
        unsafe { debug.cmd_begin_debug_utils_label(self.command, &info) };
    }

    /// Ends the last debug label.
    pub(in crate::gpu) fn unlabel(&self) {
        if let Some(debug) = &self.context.extensions.debug {
            // SAFETY: pairs with `label`.
            unsafe { debug.cmd_end_debug_utils_label(self.command) };
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

    /// Writes the end timestamp.
    pub(in crate::gpu) fn end_timing(&self, mark: &Mark) {
        if let Mark::Query(index) = mark {
            self.queries.end(self.command, *index);
        }
    }

    /// With [`Timing::Work`], stores the draw count and traffic of the pass just recorded.
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

    /// With [`Timing::Isolated`], submits the pass just recorded, waits, and begins the command buffer again.
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
        // Other work may go on, of frames of a window for instance.
        if self.is_pending {
            self.context.settle();
        }
        let Some(raw) = self.context.freeing() else {
            return;
        };
        // SAFETY: the work of this recorder is done or the device lost; null handles are ignored.
        unsafe {
            raw.destroy_fence(self.fence, None);
            raw.destroy_command_pool(self.command_pool, None);
        }
    }
}

/// Handle of the timing or work query of a pass.
pub(in crate::gpu) enum Mark {
    None,
    Query(u32),
    Wall(&'static str),
    Work(usize),
}
