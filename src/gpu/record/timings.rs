//! Pass times.

use std::sync::Arc;
use std::time::{Duration, Instant};

use ash::vk;
use cpu_time::ProcessTime;

use crate::gpu::device::context::Context;
use crate::gpu::error::{During, Result};

/// How passes are timed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Timing {
    /// Not timed.
    #[default]
    Off,
    /// Timestamp queries within one submission.
    Timestamps,
    /// Wall clock, with each pass submitted and waited for separately. Also reliable on software drivers.
    Isolated,
    /// Not timed: bytes and pipeline statistics are counted instead, because counting would distort times.
    Work,
}

/// Time of one pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassTime {
    /// Name of the pass.
    pub name: &'static str,
    /// Device time, or wall time with [`Timing::Isolated`], milliseconds.
    pub ms: f64,
    /// CPU time of all threads of this process with [`Timing::Isolated`], milliseconds. On a software driver it hardly depends
    /// on the machine load.
    pub cpu_ms: f64,
}

/// Pass times of one frame, in recording order.
#[derive(Debug, Clone, Default)]
pub struct Timings {
    passes: Vec<PassTime>,
}

/// Wall clock and process CPU clock.
#[derive(Debug, Clone, Copy)]
pub struct Stopwatch {
    wall: Instant,
    cpu: ProcessTime,
}

impl Stopwatch {
    /// Starts both clocks.
    pub fn start() -> Self {
        Self {
            wall: Instant::now(),
            cpu: ProcessTime::now(),
        }
    }

    /// Wall time and CPU time of all threads since `start`, milliseconds.
    pub fn elapsed_ms(&self) -> (f64, f64) {
        let ms = |d: Duration| d.as_secs_f64() * 1e3;
        (ms(self.wall.elapsed()), ms(self.cpu.elapsed()))
    }
}

impl Timings {
    pub(in crate::gpu) fn clear(&mut self) {
        self.passes.clear();
    }

    pub(in crate::gpu) fn push(&mut self, time: PassTime) {
        self.passes.push(time);
    }

    /// Times of all passes.
    pub fn passes(&self) -> &[PassTime] {
        &self.passes
    }
}

const MAX_PASSES: u32 = 128;

/// Timestamp queries of one frame.
pub(in crate::gpu) struct Queries {
    context: Arc<Context>,
    pool: vk::QueryPool,
    names: Vec<&'static str>,
}

/// Ticks from one timestamp to a later one; the counter starts again at 0 after its last bit that counts.
fn ticks_between(from: u64, to: u64, bits: u32) -> u64 {
    let mask = u64::MAX.checked_shr(64 - bits.min(64)).unwrap_or(0);
    to.wrapping_sub(from) & mask
}

impl Queries {
    pub(in crate::gpu) fn new(context: &Arc<Context>) -> Result<Self> {
        let info = vk::QueryPoolCreateInfo::default()
            .query_type(vk::QueryType::TIMESTAMP)
            .query_count(2 * MAX_PASSES);
        // SAFETY: the info has no pointers.
        let pool = unsafe { context.raw().create_query_pool(&info, None) }
            .during("create timestamp queries")?;
        Ok(Self {
            context: context.clone(),
            pool,
            names: Vec::new(),
        })
    }

    pub(in crate::gpu) fn reset(&mut self) {
        self.names.clear();
        // SAFETY: hostQueryReset is enabled and no pending submission uses the pool.
        unsafe {
            self.context
                .raw()
                .reset_query_pool(self.pool, 0, 2 * MAX_PASSES)
        };
    }

    /// Index of the pass, or `None` if the pool is full.
    pub(in crate::gpu) fn begin(
        &mut self,
        command: vk::CommandBuffer,
        name: &'static str,
    ) -> Option<u32> {
        let index = u32::try_from(self.names.len())
            .ok()
            .filter(|i| *i < MAX_PASSES)?;
        self.names.push(name);
        self.write(command, 2 * index);
        Some(index)
    }

    pub(in crate::gpu) fn end(&self, command: vk::CommandBuffer, index: u32) {
        self.write(command, 2 * index + 1);
    }

    fn write(&self, command: vk::CommandBuffer, query: u32) {
        // SAFETY: the command buffer is recording and the query was reset.
        unsafe {
            self.context.raw().cmd_write_timestamp2(
                command,
                vk::PipelineStageFlags2::ALL_COMMANDS,
                self.pool,
                query,
            );
        }
    }

    /// Reads the finished queries.
    pub(in crate::gpu) fn collect(&self, into: &mut Timings) -> Result<()> {
        let mut ticks = vec![0u64; 2 * self.names.len()];
        if ticks.is_empty() {
            return Ok(());
        }
        // SAFETY: the submission was waited for, so all queries are available.
        unsafe {
            self.context.raw().get_query_pool_results(
                self.pool,
                0,
                &mut ticks,
                vk::QueryResultFlags::TYPE_64,
            )
        }
        .during("read timestamps")?;
        let to_ms = f64::from(self.context.limits.timestamp_period) * 1e-6;
        let bits = self.context.summary().timestamp_bits;
        for (name, pair) in self.names.iter().zip(ticks.chunks_exact(2)) {
            let ms = ticks_between(pair[0], pair[1], bits) as f64 * to_ms;
            into.push(PassTime {
                name,
                ms,
                cpu_ms: f64::NAN,
            });
        }
        Ok(())
    }
}

impl Drop for Queries {
    fn drop(&mut self) {
        if let Some(raw) = self.context.freeing() {
            // SAFETY: the recorder that owns this has waited for its work.
            unsafe { raw.destroy_query_pool(self.pool, None) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_counter_that_starts_again_is_no_negative_time() {
        assert_eq!(ticks_between(5, 25, 64), 20);
        assert_eq!(ticks_between(u64::MAX - 4, 5, 64), 10);
        assert_eq!(ticks_between((1 << 36) - 10, 20, 36), 30);
        // Bits that do not count may hold anything.
        assert_eq!(ticks_between(0xabc << 36 | 7, 0x123 << 36 | 9, 36), 2);
        assert_eq!(ticks_between(1, 9, 0), 0);
    }
}
