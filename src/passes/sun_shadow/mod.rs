//! The sun's shadow maps: fitting to the view, cascades, drawing, and caster culling.

pub mod cascades;
pub mod fit;
mod glass;
pub mod map;
pub mod perspective;
pub mod receiver_mask;
