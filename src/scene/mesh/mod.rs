//! Triangles: reading order to drawing order, normals, tangents.

pub(in crate::scene) mod arena;
pub(in crate::scene) mod instance;
pub(in crate::scene) mod normals;
pub(in crate::scene) mod soup;
mod subdivide;
pub(in crate::scene) mod triangulate;
