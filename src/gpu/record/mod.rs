//! Recording of passes: barriers, draws, timings.

pub mod access;
pub(in crate::gpu) mod compute;
pub(in crate::gpu) mod draws;
pub(in crate::gpu) mod labels;
pub(in crate::gpu) mod pass;
pub(in crate::gpu) mod push_words;
pub(in crate::gpu) mod recorder;
pub(in crate::gpu) mod timings;
pub(in crate::gpu) mod transitions;
pub(in crate::gpu) mod work;
