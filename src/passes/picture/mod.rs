//! From radiance to a displayed picture: averages over frames, exposure, tone mapping, presentation.

pub mod accumulate;
pub mod exposure;
pub mod fade;
pub mod present;
pub mod tone_map;
