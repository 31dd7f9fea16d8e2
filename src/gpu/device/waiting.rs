//! Waiting for a device, which may hang.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use ash::vk;

use crate::gpu::device::context::Context;
use crate::gpu::device::fault::Call;
use crate::gpu::error::{During, GpuError, Result};

impl Context {
    /// How long work may take. Drivers reset a GPU after seconds; on the CPU a large picture takes minutes.
    pub(in crate::gpu) fn longest_wait(&self) -> Duration {
        Duration::from_secs(if self.summary().is_software() {
            3600
        } else {
            60
        })
    }

    /// The error of a wait for the device. A device that hangs stays open to the end of the process.
    pub(in crate::gpu) fn unanswered(
        self: &Arc<Self>,
        result: vk::Result,
        waited: Duration,
    ) -> GpuError {
        if result != vk::Result::TIMEOUT {
            return GpuError::Vulkan {
                what: "wait for the device",
                result,
            };
        }
        if !self.is_hung.swap(true, Ordering::Relaxed) {
            std::mem::forget(Arc::clone(self));
        }
        self.hung(waited)
    }

    fn hung(&self, waited: Duration) -> GpuError {
        GpuError::Hung {
            device: self.summary().name.clone(),
            seconds: waited.as_secs(),
        }
    }

    /// The device, to free what belongs to it. `None` if it hangs: what it may still use is left to the end of the process.
    pub(in crate::gpu) fn freeing(&self) -> Option<&ash::Device> {
        (!self.is_hung.load(Ordering::Relaxed)).then(|| self.raw())
    }

    /// Waits until the device is idle, before resources are freed. A device that is lost or hangs does nothing any more.
    pub(in crate::gpu) fn settle(&self) {
        if let Some(raw) = self.freeing() {
            let _queue = self.queue();
            // SAFETY: no other thread uses the queue meanwhile.
            let _ = unsafe { raw.device_wait_idle() };
        }
    }

    /// Waits until the device is idle.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn wait_idle(&self) -> Result<()> {
        if self.is_hung.load(Ordering::Relaxed) {
            return Err(self.hung(self.longest_wait()));
        }
        let planned = self.faults.at(Call::Wait);
        let _queue = self.queue();
        // SAFETY: no other thread uses the queue meanwhile.
        let waited = unsafe { self.raw().device_wait_idle() };
        planned.and(waited).during("wait for the device")
    }
}
