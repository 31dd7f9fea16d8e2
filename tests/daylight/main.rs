//! The physics against closed forms and reference values; needs no GPU.

#[path = "../common/mod.rs"]
mod common;

mod irradiance;
mod reference;
mod sampling;
mod sun_position;
mod tone_curves_and_frames;
