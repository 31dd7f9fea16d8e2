//! Data for culling and occlusion: closed bodies, clusters of triangles, their order in the index buffer.

pub mod bodies;
pub mod clusters;
pub mod layout;
