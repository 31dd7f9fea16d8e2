//! From radiance to a displayed picture: averages over frames, exposure, tone mapping, presentation.

pub mod accumulate;
pub mod exposure;
pub mod fade;
#[cfg(feature = "window")]
pub mod present;
pub mod tone_map;
