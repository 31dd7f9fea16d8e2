//! Light that surfaces reflect onto each other: rays through the scene, and a cache of irradiance in cells of space.

pub mod trace;
pub mod tree;
