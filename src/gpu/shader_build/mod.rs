//! GLSL to SPIR-V, and what a stage declares, in the words of this crate's source. Used by build.rs, and at run time by
//! builds that reload their shaders.

mod compile;
mod reflect;

pub use compile::compile;
pub use reflect::declarations;
