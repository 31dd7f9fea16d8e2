//! The render passes, grouped by topic. Each owns its pipeline and the images it writes; the images it reads are parameters.
//!
//! Units on the device are kcd/m² and klx (half floats end at 65 504); files and the CPU use cd/m² and lux.

pub mod bounces;
pub mod dome;
pub mod light;
pub mod occlusion;
pub mod picture;
pub mod route;
pub mod sky;
pub mod sun_shadow;
pub mod surfaces;
pub mod view;

use std::sync::Arc;

use glam::{DVec3, Vec3};

use crate::daylight::glass;
use crate::gpu::{
    Blend, Context, Depth, Format, Pipeline, PipelineDesc, Result, Route, Shader, shaders,
};

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

/// The shaders of a full-screen pass: the same function as a fragment and as a compute shader.
#[derive(Clone, Copy)]
struct Screen {
    fragment: &'static Shader,
    /// Its storage images have the names and the formats of the targets.
    compute: &'static Shader,
}

/// A full-screen pipeline by the route of the device, see [`crate::gpu::Route`]. `depth` selects the pixels: those of [`Depth::Surface`] and
/// [`Depth::Background`] a compute shader selects itself.
fn screen(
    context: &Arc<Context>,
    name: &str,
    shaders: Screen,
    targets: &[Format],
    depth: Depth,
    constants: &[(&str, u32)],
) -> Result<Pipeline> {
    let route = context.route();
    screen_by(route, context, name, shaders, targets, depth, constants)
}

/// The same, by this route.
fn screen_by(
    route: Route,
    context: &Arc<Context>,
    name: &str,
    shaders: Screen,
    targets: &[Format],
    depth: Depth,
    constants: &[(&str, u32)],
) -> Result<Pipeline> {
    match route {
        Route::Fragment => {
            fullscreen_at(context, name, shaders.fragment, targets, depth, constants)
        }
        Route::Compute => compute(context, name, shaders.compute, constants),
    }
}

/// A full-screen pipeline with one render target, by fragments alone: morphological anti-aliasing, and presenting, whose images cannot be stored to.
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
