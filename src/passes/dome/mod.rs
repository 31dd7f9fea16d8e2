//! The sky's visibility by shadow maps from directions of the sky, averaged over converging frames.

pub mod gather;
pub mod specular;
