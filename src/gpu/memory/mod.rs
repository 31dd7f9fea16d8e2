//! Images, buffers, uploads and read-back.

pub(in crate::gpu) mod buffer;
pub(in crate::gpu) mod image;
pub(in crate::gpu) mod read_back;
pub(in crate::gpu) mod upload;
