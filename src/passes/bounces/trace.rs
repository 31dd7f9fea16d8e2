//! Given rays through the scene, for tests against the CPU.

use crate::gpu::{
    Buffer, BufferKind, Format, Image, ImageDesc, Pipeline, Recorder, Result, shaders,
    upload_buffer,
};
use crate::gpu_struct;
use crate::passes::bounces::tree::Tree;
use crate::passes::compute;
use crate::scene::Ray;

gpu_struct! {
    /// Number of rays.
    pub struct Push: push of TRACE_COMP {
        count: u32,
    }
}

/// What is asked about a ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Query {
    /// Its nearest hit.
    Closest,
    /// Whether it hits anything.
    Any,
}

/// Rays on the device and the pass that traces them.
pub struct Trace {
    pipeline: Pipeline,
    rays: Buffer,
    count: u32,
    hits: Image,
}

/// Columns of the image of hits.
const COLUMNS: u32 = 1024;

impl Trace {
    /// Uploads the rays; `recorder` must be recording.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(recorder: &mut Recorder, tree: &Tree, rays: &[Ray], query: Query) -> Result<Self> {
        let context = recorder.context().clone();
        let mut constants = tree.facts().constants().to_vec();
        constants.push(("ANY", (query == Query::Any).into()));
        let pipeline = compute(&context, "trace", &shaders::TRACE_COMP, &constants)?;
        let words: Vec<[f32; 3]> = rays
            .iter()
            .flat_map(|ray| [ray.origin.to_array(), ray.direction.to_array()])
            .collect();
        let count = rays.len() as u32;
        let size = [COLUMNS, count.div_ceil(COLUMNS).max(1)];
        let desc = ImageDesc::flat("hits", Format::R32G32B32A32_SFLOAT, size);
        Ok(Self {
            pipeline,
            rays: upload_buffer(
                recorder,
                "rays",
                BufferKind::Storage,
                bytemuck::cast_slice(&words),
            )?,
            count,
            hits: Image::new(&context, &desc.stored())?,
        })
    }

    /// Traces the rays.
    pub fn record(&self, recorder: &mut Recorder, tree: &Tree) {
        let pass = recorder.pass("trace", &self.pipeline);
        tree.bound_to(pass)
            .storage("Rays", &self.rays)
            .store("hits", &self.hits)
            .push(&Push { count: self.count })
            .dispatch_over([self.count, 1, 1]);
    }

    /// The results; texel i, row by row, is for ray i. For the nearest hit: distance (1e30: none), position in
    /// [`Tree::numbers`], barycentric weights of the second and third corner. Otherwise 1 if there
    /// is a hit and 0 if not.
    pub fn hits(&self) -> &Image {
        &self.hits
    }
}
