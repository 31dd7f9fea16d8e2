//! Light that surfaces reflect onto each other: rays through the scene, and a cache of irradiance in cells of space.

pub mod cells;
pub mod gather;
pub mod trace;
pub mod tree;
mod wide;
