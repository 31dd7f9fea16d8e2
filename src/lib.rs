//! Real-time daylight whose numbers can be trusted.

pub mod cli;
pub mod daylight;
pub mod error;
pub mod faces;
pub mod frame;
pub mod gpu;
pub mod output;
pub mod passes;
pub mod scene;
pub mod settings;
