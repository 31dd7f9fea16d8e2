//! The window: a walk through daylight.
//!
//! - [`controls`]: from drags, wheel and keys to a camera; no device, no window.
//! - [`viewpoints`]: places to come back to.

pub mod controls;
pub mod viewpoints;
