//! The sun's shadow maps: their fit to the view, their cascades, their casters, and which casters the picture needs.

pub mod cascades;
pub mod fit;
pub mod map;
pub mod perspective;
pub mod receiver_mask;
