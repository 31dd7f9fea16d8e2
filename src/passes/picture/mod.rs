//! From radiance to the displayed picture: accumulation, exposure, tone mapping, presentation.

pub mod accumulate;
pub mod exposure;
pub mod fade;
#[cfg(feature = "window")]
pub mod present;
pub mod tone_map;
