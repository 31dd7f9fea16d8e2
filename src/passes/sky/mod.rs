//! The sky and its irradiance as cubes.

pub mod air;
pub mod atmosphere;
pub mod cube;
pub mod irradiance;
mod mips;
pub mod route;
pub mod specular;
