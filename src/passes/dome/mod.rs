//! The sky's visibility from shadow maps of sampled directions, averaged over converging frames.

pub mod gather;
pub mod specular;
