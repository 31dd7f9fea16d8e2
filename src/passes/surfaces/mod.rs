//! The G-buffer, the scene's geometry on the device, and culling.

pub mod culling;
pub mod facts;
pub mod gbuffer;
pub mod geometry;
mod triangles;
pub(in crate::passes) mod upload;
