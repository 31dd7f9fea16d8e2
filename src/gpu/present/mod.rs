//! Presentation to a window: swapchain, frames in flight, user interface.

pub(in crate::gpu) mod output;
pub(in crate::gpu) mod presenter;
pub(in crate::gpu) mod swapchain;
pub(in crate::gpu) mod ui;
