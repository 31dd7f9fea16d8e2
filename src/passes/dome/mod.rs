//! The sky's visibility by shadow maps from directions of the dome: what converging frames add up.

pub mod block;
pub mod gather;
pub mod specular;
