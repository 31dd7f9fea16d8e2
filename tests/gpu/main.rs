//! Output of the device against the CPU, closed forms and itself, under validation.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/gpu.rs"]
mod gpu;
#[path = "../common/room.rs"]
mod room;
#[path = "../common/truth.rs"]
mod truth;

mod air;
mod atmosphere;
mod bounces;
mod canary;
mod convergence;
mod culling;
mod details;
mod dome;
mod dome_by;
mod emission;
mod furnace;
mod glass;
mod golden;
#[cfg(feature = "window")]
mod grid_cells;
mod irradiance;
mod lighting;
mod lobes;
mod moon;
mod moving_light;
mod penumbra;
mod pipelines;
#[cfg(feature = "window")]
mod present;
mod probe;
mod rays;
mod reflections;
mod routes;
mod shadow;
mod sheets;
mod sky;
mod smooth;
mod specular;
mod ssao;
mod stars;
mod steady_frame;
mod timings;
mod tone;
mod transaction;
mod uploads;
mod validate;
