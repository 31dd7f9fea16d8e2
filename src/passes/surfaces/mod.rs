//! The G-buffer: what is seen in each pixel, and the scene's geometry that it is drawn from.

pub mod culling;
pub mod gbuffer;
pub mod geometry;
pub(in crate::passes) mod upload;
