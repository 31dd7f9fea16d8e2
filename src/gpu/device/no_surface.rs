//! Replaces `surface` in builds without the `window` feature. Its types are uninhabited.

use std::convert::Infallible;
use std::ffi::c_char;

use ash::vk;

use crate::gpu::error::Result;

pub(in crate::gpu) type Window = Infallible;

pub(in crate::gpu) fn instance_extensions(
    _: &ash::Entry,
    window: &Window,
) -> Result<Vec<*const c_char>> {
    match *window {}
}

pub(in crate::gpu) struct RawSurface(Infallible);

impl RawSurface {
    pub(in crate::gpu) fn new(_: &ash::Entry, _: &ash::Instance, window: Window) -> Result<Self> {
        match window {}
    }

    pub(in crate::gpu) fn is_supported(&self, _: vk::PhysicalDevice, _: u32) -> Result<bool> {
        match self.0 {}
    }
}
