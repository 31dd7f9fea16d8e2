//! Ambient occlusion: an estimate of the sky's visibility for pictures that move.

pub mod height_map;
pub mod ssao;
