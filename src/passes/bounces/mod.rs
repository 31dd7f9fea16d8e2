//! Light that surfaces reflect onto each other: rays through the scene, and a cache of irradiance in cells of space.

pub mod ambient;
pub mod cells;
mod change;
pub mod gather;
mod shared_exponent;
pub mod trace;
pub mod tree;
mod wide;
