//! The render passes, grouped by topic. Each owns its pipeline and the images it writes; the images it reads are parameters.
//!
//! Units on the device are kcd/m² and klx (half floats end at 65 504); files and the CPU use cd/m² and lux.

pub mod bounces;
pub mod dome;
pub mod light;
pub mod occlusion;
pub mod picture;
pub mod sky;
pub mod sun_shadow;
pub mod surfaces;
pub mod view;

use std::sync::Arc;

use glam::{DVec3, Vec3};

use crate::daylight::glass;
use crate::gpu::{Blend, Context, Depth, Format, Pipeline, PipelineDesc, Result, Shader, shaders};

/// cd/m² to kcd/m², lux to klx.
fn kilo(rgb: DVec3) -> Vec3 {
    (rgb * 1e-3).as_vec3()
}

/// The index of refraction for `include/glass.glsl`.
fn glass_index() -> (&'static str, u32) {
    ("GLASS_INDEX", (glass::INDEX as f32).to_bits())
}

/// A compute pipeline.
fn compute(
    context: &Arc<Context>,
    name: &str,
    shader: &'static Shader,
    constants: &[(&str, u32)],
) -> Result<Pipeline> {
    Pipeline::new(
        context,
        &PipelineDesc {
            name,
            stages: &[shader],
            vertex: &[],
            colors: &[],
            depth: Depth::Off,
            blend: Blend::Off,
            constants,
        },
    )
}

/// A full-screen pipeline with one render target.
fn fullscreen(
    context: &Arc<Context>,
    name: &str,
    fragment: &'static Shader,
    target: Format,
    constants: &[(&str, u32)],
) -> Result<Pipeline> {
    fullscreen_at(context, name, fragment, &[target], Depth::Off, constants)
}

/// A full-screen pipeline with several render targets; the depth test selects the pixels.
fn fullscreen_at(
    context: &Arc<Context>,
    name: &str,
    fragment: &'static Shader,
    colors: &[Format],
    depth: Depth,
    constants: &[(&str, u32)],
) -> Result<Pipeline> {
    Pipeline::new(
        context,
        &PipelineDesc {
            name,
            stages: &[&shaders::FULLSCREEN_VERT, fragment],
            vertex: &[],
            colors,
            depth,
            blend: Blend::Off,
            constants,
        },
    )
}
