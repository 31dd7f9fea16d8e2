//! The sky and its irradiance as cubes.

pub mod cube;
pub mod irradiance;
pub mod route;
