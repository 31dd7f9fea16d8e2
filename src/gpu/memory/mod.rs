//! Images and buffers, and copies to and from them.

pub(in crate::gpu) mod buffer;
pub(in crate::gpu) mod image;
pub(in crate::gpu) mod mips;
pub(in crate::gpu) mod read_back;
pub(in crate::gpu) mod sampler;
pub(in crate::gpu) mod upload;
