//! Light that surfaces reflect onto each other: rays through the scene, and a cache of irradiance in cells of space.

pub mod ambient;
pub mod cells;
mod change;
pub mod gather;
pub mod trace;
pub mod tree;
mod wide;
