//! Compilation of GLSL to SPIR-V and reflection of the stage interface as Rust source. Used by build.rs, and at run time by
//! builds with hot reload.

mod compile;
mod reflect;

pub use compile::compile;
pub use reflect::declarations;
