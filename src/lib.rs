//! Real-time daylight whose numbers can be trusted.

pub mod daylight;
pub mod gpu;
pub mod scene;
