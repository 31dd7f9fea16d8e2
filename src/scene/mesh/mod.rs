//! Meshes: triangulation, normals, welding into the arena of a scene, instances.

pub mod arena;
pub mod instance;
pub mod normals;
pub mod soup;
pub mod triangulate;
