//! Ambient occlusion: a single-frame estimate of the sky's visibility.

pub mod ssao;
