//! The physics against closed forms and reference values; needs no GPU.

#[path = "../common/mod.rs"]
mod common;

mod atmosphere;
mod bounces;
mod emission;
mod ggx;
mod glass;
mod grey_skies;
mod irradiance;
mod made_grids;
mod moon;
mod reference;
mod rooms;
mod sampling;
mod sun_position;
mod tone_curves_and_frames;
mod wavelengths;
mod weather;

use skylight::validate::model;
