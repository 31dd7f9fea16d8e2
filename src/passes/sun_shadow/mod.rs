//! The sun's shadow maps: their fit to the view, their cascades, their casters.

pub mod cascades;
pub mod fit;
pub mod map;
pub mod receiver_mask;
