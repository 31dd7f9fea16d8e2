//! The stars: points of light added to the background, in pixels without a surface. They are not in the sky cube.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use crate::daylight::sky::Daylight;
use crate::daylight::stars::catalogue;
use crate::gpu::{
    Buffer, BufferKind, Context, Depth, Format, Image, Load, Pipeline, PipelineDesc, Recorder,
    Result, shaders,
};
use crate::gpu_struct;

use crate::passes::kilo;
use crate::passes::view::View;

gpu_struct! {
    /// Size of the picture.
    pub struct Push: push of STARS_VERT {
        size: Vec2,
    }
}

/// Direction and illuminance of a star.
type Entry = [Vec3; 2];

/// The pass that draws the stars.
pub struct Stars {
    pipeline: Pipeline,
    table: Buffer,
    /// The daylight whose stars are in the table, and their number.
    drawn: Option<(Daylight, u32)>,
}

impl Stars {
    /// The pass for pictures of `format`; `None` if the device cannot add to them.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, format: Format) -> Result<Option<Self>> {
        if !context.can_blend(format) {
            return Ok(None);
        }
        let desc = PipelineDesc {
            name: "stars",
            stages: &[&shaders::STARS_VERT, &shaders::STARS_FRAG],
            vertex: &[],
            colors: &[format],
            adds: true,
            depth: Depth::Background(Format::D32_SFLOAT),
            constants: &[],
        };
        let bytes = (catalogue().len() * size_of::<Entry>()) as u64;
        Ok(Some(Self {
            pipeline: Pipeline::new(context, &desc)?,
            table: Buffer::new(context, "stars", BufferKind::Storage, bytes)?,
            drawn: None,
        }))
    }

    /// Adds the stars of `daylight` to a picture.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        depth: &Image,
        daylight: &Daylight,
        view: &View,
        radiance: &Image,
    ) {
        if daylight.stars.is_none() {
            return;
        }
        if self
            .drawn
            .as_ref()
            .is_none_or(|(drawn, _)| drawn != daylight)
        {
            let entries: Vec<Entry> = daylight
                .stars()
                .iter()
                .map(|star| [star.direction.as_vec3(), kilo(star.illuminance)])
                .collect();
            recorder.write(&self.table, bytemuck::cast_slice(&entries));
            self.drawn = Some((daylight.clone(), entries.len() as u32));
        }
        let count = self.drawn.as_ref().map_or(0, |(_, count)| *count);
        recorder
            .pass("stars", &self.pipeline)
            .storage("table", &self.table)
            .uniform("view", &view.block())
            .push(&Push {
                size: view.size.as_vec2(),
            })
            .color(radiance, Load::Keep)
            .depth_test(depth)
            .draws(|draws| draws.vertices(6 * count));
    }
}
