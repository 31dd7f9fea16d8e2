//! The sky's visibility from shadow maps of sampled directions, averaged over converging frames.

pub mod gather;
mod maps;
mod rays;
pub mod route;
pub mod specular;
