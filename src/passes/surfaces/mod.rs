//! The G-buffer: what is seen in each pixel, and the scene's geometry that it is drawn from.

pub mod culling;
mod draw_runs;
pub mod gbuffer;
pub mod geometry;
mod upload;
