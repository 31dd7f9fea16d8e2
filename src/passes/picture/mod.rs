//! From radiance to the displayed picture: accumulation, exposure, tone mapping, anti-aliasing, presentation.

pub mod accumulate;
pub mod exposure;
pub mod fade;
pub mod hand_over;
pub mod morphological;
#[cfg(feature = "window")]
pub mod present;
pub mod temporal;
pub mod tone_map;
