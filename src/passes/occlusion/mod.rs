//! Ambient occlusion: a single-frame estimate of the sky's visibility.

pub mod height_map;
pub mod ssao;
