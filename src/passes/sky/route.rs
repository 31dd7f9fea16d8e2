//! Two ways to write all texels of a cube: layered rendering with a geometry shader, as in the lecture, and compute for devices
//! without geometry shaders, and for those that compute faster than they draw ([`Route`]).

use std::sync::Arc;

use crate::gpu::{
    Blend, Context, Depth, Format, Image, Load, Optional, Pass, Pipeline, PipelineDesc, Recorder,
    Result, Route, Shader, shaders,
};

/// How the texels of a cube are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CubeRoute {
    /// A geometry shader emits one triangle to the six faces (`gl_Layer`), as in the lecture.
    Geometry,
    /// A compute shader with one invocation per texel.
    Compute,
}

impl CubeRoute {
    /// `Geometry` if the device has geometry shaders and takes fragments for full-screen passes, otherwise `Compute`.
    pub fn of(context: &Context) -> Self {
        let has_geometry = context.summary().has(Optional::GeometryShader);
        match context.route() {
            Route::Fragment if has_geometry => Self::Geometry,
            _ => Self::Compute,
        }
    }
}

/// The shaders that fill a cube: the same function as a fragment and as a compute shader.
#[derive(Clone, Copy)]
pub(in crate::passes) struct CubeShaders {
    /// For [`CubeRoute::Geometry`].
    pub(in crate::passes) fragment: &'static Shader,
    /// For [`CubeRoute::Compute`]; its storage images have the names of the fragment shader's outputs.
    pub(in crate::passes) compute: &'static Shader,
}

/// A pipeline that writes all texels of cubes.
pub(in crate::passes) struct CubePipeline {
    route: CubeRoute,
    pipeline: Pipeline,
}

impl CubePipeline {
    /// Creates a pipeline for cubes of these formats.
    pub(in crate::passes) fn new(
        context: &Arc<Context>,
        route: CubeRoute,
        name: &str,
        shaders: CubeShaders,
        formats: &[Format],
        constants: &[(&str, u32)],
    ) -> Result<Self> {
        let layered = [
            &shaders::FULLSCREEN_VERT,
            &shaders::CUBE_FACES_GEOM,
            shaders.fragment,
        ];
        let (stages, colors): (&[&'static Shader], _) = match route {
            CubeRoute::Geometry => (&layered, formats),
            CubeRoute::Compute => (&[shaders.compute], &[][..]),
        };
        let desc = PipelineDesc {
            name,
            stages,
            vertex: &[],
            colors,
            depth: Depth::Off,
            blend: Blend::Off,
            constants,
        };
        Ok(Self {
            route,
            pipeline: Pipeline::new(context, &desc)?,
        })
    }

    /// Starts the pass. Bind the shader's inputs, then call [`CubePipeline::fill`].
    pub(in crate::passes) fn pass<'r>(
        &'r self,
        recorder: &'r mut Recorder,
        name: &'static str,
    ) -> Pass<'r> {
        recorder.pass(name, &self.pipeline)
    }

    /// Ends the pass: writes every texel of the cubes, given by name in the order of the fragment shader's outputs.
    pub(in crate::passes) fn fill<'r>(&self, pass: Pass<'r>, cubes: &[(&str, &'r Image)]) {
        match self.route {
            CubeRoute::Geometry => cubes
                .iter()
                .fold(pass, |pass, (_, cube)| pass.color(cube, Load::Discard))
                .draw(),
            CubeRoute::Compute => cubes
                .iter()
                .fold(pass, |pass, (name, cube)| pass.store(name, cube))
                .dispatch(),
        }
    }
}
