//! From radiance to the displayed picture: accumulation, exposure, tone mapping, anti-aliasing, cells of sensors, presentation.

pub mod accumulate;
pub mod exposure;
pub mod fade;
#[cfg(feature = "window")]
pub mod grid_cells;
pub mod hand_over;
pub mod morphological;
#[cfg(feature = "window")]
pub mod present;
pub mod temporal;
pub mod tone_map;
