//! The device: instance, device selection, window surface, validation, fault injection.

pub(in crate::gpu) mod context;
pub(in crate::gpu) mod fault;
pub(in crate::gpu) mod instance;
pub(in crate::gpu) mod memory_heaps;
pub(in crate::gpu) mod needs;
pub(in crate::gpu) mod optional;
pub(in crate::gpu) mod portability;
pub(in crate::gpu) mod select;
pub(in crate::gpu) mod startup;
#[cfg(feature = "window")]
pub(in crate::gpu) mod surface;
#[cfg(not(feature = "window"))]
#[path = "no_surface.rs"]
pub(in crate::gpu) mod surface;
pub(in crate::gpu) mod validation;
mod waiting;
