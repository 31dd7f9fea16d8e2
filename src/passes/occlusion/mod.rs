//! Ambient occlusion: the sky's visibility as the moving picture knows it.

pub mod height_map;
pub mod ssao;
