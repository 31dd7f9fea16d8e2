//! The window: swapchain, presentation, the panels over the picture.

pub(in crate::gpu) mod presenter;
pub(in crate::gpu) mod swapchain;
pub(in crate::gpu) mod ui;
