//! How a scene is drawn: closed bodies, clusters of triangles, their order in the index buffer.

pub(in crate::scene) mod bodies;
pub(in crate::scene) mod cached_layout;
pub(in crate::scene) mod clusters;
pub(in crate::scene) mod layout;
