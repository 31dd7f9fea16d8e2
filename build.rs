//! Compiles `shaders_glsl/` to SPIR-V.
fn main() {}
