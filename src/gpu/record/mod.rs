//! Recording of passes: barriers, draws, timings.

pub mod access;
pub(in crate::gpu) mod barriers;
pub(in crate::gpu) mod compute;
pub(in crate::gpu) mod descriptors;
pub(in crate::gpu) mod draws;
pub(in crate::gpu) mod pass;
pub(in crate::gpu) mod recorder;
pub(in crate::gpu) mod screen;
pub(in crate::gpu) mod timings;
pub(in crate::gpu) mod work;
