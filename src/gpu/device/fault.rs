//! Fault injection: a test names a Vulkan call, and that call returns an error as if the driver had failed.
//!
//! Without a planned fault, a call costs one atomic load. Tests and users run the same build.

use std::str::FromStr;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Mutex, PoisonError};

use ash::vk;

use crate::gpu::error::GpuError;

/// Calls that can be made to fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::gpu) enum Call {
    /// Allocating device memory, of buffers and images.
    Memory,
    /// Creating a buffer.
    Buffer,
    /// Creating an image.
    Image,
    /// Creating a pipeline.
    Pipeline,
    /// Allocating a descriptor set.
    Descriptors,
    /// Beginning a command buffer.
    Record,
    /// Submitting work.
    Submit,
    /// Waiting for work.
    Wait,
    /// Querying the capabilities of the window's surface.
    Surface,
    /// Acquiring a swapchain image.
    Acquire,
    /// Presenting to the window.
    Present,
}

const CALLS: [(&str, Call); 11] = [
    ("memory", Call::Memory),
    ("buffer", Call::Buffer),
    ("image", Call::Image),
    ("pipeline", Call::Pipeline),
    ("descriptors", Call::Descriptors),
    ("record", Call::Record),
    ("submit", Call::Submit),
    ("wait", Call::Wait),
    ("surface", Call::Surface),
    ("acquire", Call::Acquire),
    ("present", Call::Present),
];

const ERRORS: [(&str, vk::Result); 7] = [
    ("device-lost", vk::Result::ERROR_DEVICE_LOST),
    (
        "out-of-device-memory",
        vk::Result::ERROR_OUT_OF_DEVICE_MEMORY,
    ),
    ("out-of-host-memory", vk::Result::ERROR_OUT_OF_HOST_MEMORY),
    ("out-of-pool-memory", vk::Result::ERROR_OUT_OF_POOL_MEMORY),
    ("surface-lost", vk::Result::ERROR_SURFACE_LOST_KHR),
    ("out-of-date", vk::Result::ERROR_OUT_OF_DATE_KHR),
    ("timeout", vk::Result::TIMEOUT),
];

/// One fault: a call, its occurrence (from 1) and the error it returns. Written as `submit@3=device-lost`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Fault {
    call: Call,
    occurrence: u32,
    error: vk::Result,
}

impl FromStr for Fault {
    type Err = GpuError;

    fn from_str(text: &str) -> Result<Self, GpuError> {
        let parse = || {
            let (call, rest) = text.split_once('@')?;
            let (occurrence, error) = rest.split_once('=')?;
            Some(Self {
                call: CALLS.iter().find(|(name, _)| *name == call)?.1,
                occurrence: occurrence.parse().ok().filter(|n| *n > 0)?,
                error: ERRORS.iter().find(|(name, _)| *name == error)?.1,
            })
        };
        parse().ok_or_else(|| GpuError::BadFault(text.to_owned()))
    }
}

/// The planned fault of a device, if any.
#[derive(Debug, Default)]
pub(in crate::gpu) struct Faults {
    is_planned: AtomicBool,
    planned: Mutex<Option<Fault>>,
    seen: AtomicU32,
}

impl Faults {
    /// Parses a description such as `memory@12=out-of-device-memory`.
    pub fn new(text: Option<&str>) -> Result<Self, GpuError> {
        let faults = Self::default();
        faults.plan(text)?;
        Ok(faults)
    }

    /// Replaces the planned fault and restarts the call count.
    pub fn plan(&self, text: Option<&str>) -> Result<(), GpuError> {
        let fault: Option<Fault> = text.map(str::parse).transpose()?;
        *self.planned.lock().unwrap_or_else(PoisonError::into_inner) = fault;
        self.seen.store(0, Ordering::Relaxed);
        self.is_planned.store(fault.is_some(), Ordering::Relaxed);
        Ok(())
    }

    /// The error to return instead of making the call, if one is due.
    #[inline]
    pub fn at(&self, call: Call) -> Result<(), vk::Result> {
        if !self.is_planned.load(Ordering::Relaxed) {
            return Ok(());
        }
        let planned = *self.planned.lock().unwrap_or_else(PoisonError::into_inner);
        planned.map_or(Ok(()), |fault| self.strike(&fault, call))
    }

    fn strike(&self, fault: &Fault, call: Call) -> Result<(), vk::Result> {
        // A lost device fails every later call; memory and surface errors may be transient.
        let is_lost = fault.error == vk::Result::ERROR_DEVICE_LOST;
        let strikes = if call == fault.call {
            let occurrence = self.seen.fetch_add(1, Ordering::Relaxed) + 1;
            occurrence == fault.occurrence || (is_lost && occurrence > fault.occurrence)
        } else {
            is_lost && self.seen.load(Ordering::Relaxed) >= fault.occurrence
        };
        if strikes { Err(fault.error) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_call_fails_once() {
        let faults = Faults::new(Some("memory@2=out-of-device-memory")).expect("a fault");
        let memory: Vec<bool> = (0..4).map(|_| faults.at(Call::Memory).is_ok()).collect();
        assert_eq!(memory, [true, false, true, true]);
        assert!(faults.at(Call::Submit).is_ok());
    }

    #[test]
    fn another_fault_is_counted_from_its_planning_on() {
        let faults = Faults::new(Some("memory@1=out-of-device-memory")).expect("a fault");
        assert!(faults.at(Call::Memory).is_err());
        let planned = faults.plan(Some("image@2=out-of-host-memory"));
        assert!(planned.is_ok() && faults.at(Call::Image).is_ok());
        assert_eq!(
            faults.at(Call::Image),
            Err(vk::Result::ERROR_OUT_OF_HOST_MEMORY)
        );
        assert!(faults.plan(None).is_ok() && faults.at(Call::Image).is_ok());
    }

    #[test]
    fn a_lost_device_stays_lost() {
        let faults = Faults::new(Some("submit@2=device-lost")).expect("a fault");
        assert!(faults.at(Call::Wait).is_ok() && faults.at(Call::Submit).is_ok());
        assert_eq!(faults.at(Call::Submit), Err(vk::Result::ERROR_DEVICE_LOST));
        for call in CALLS.map(|(_, call)| call) {
            assert!(faults.at(call).is_err(), "{call:?}");
        }
    }

    #[test]
    fn without_a_fault_nothing_fails() {
        let faults = Faults::new(None).expect("none");
        assert!((0..9).all(|_| CALLS.iter().all(|(_, call)| faults.at(*call).is_ok())));
    }

    #[test]
    fn other_texts_are_refused_with_the_form() {
        for text in [
            "",
            "submit",
            "submit@0=device-lost",
            "jump@1=device-lost",
            "wait@1=tired",
        ] {
            let line = Faults::new(Some(text)).expect_err(text).to_string();
            assert!(line.contains("CALL@OCCURRENCE=ERROR"), "{line}");
        }
    }
}
