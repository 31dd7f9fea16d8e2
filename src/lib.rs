//! Real-time daylight whose numbers can be trusted.

pub mod cli;
pub mod daylight;
pub mod frame;
pub mod gpu;
pub mod passes;
pub mod scene;
pub mod settings;
