//! The cells of a grid of sensors over the displayed picture, each in one colour, hidden by the surfaces before them.

use std::sync::Arc;

use glam::Vec3;

use crate::gpu::{
    Blend, Buffer, BufferKind, Context, Depth, Image, ImageDesc, Load, Pipeline, PipelineDesc,
    Recorder, Result, Sampler, shaders,
};
use crate::gpu_struct;

use crate::passes::picture::hand_over::HandOver;
use crate::passes::picture::tone_map::is_linear;
use crate::passes::view::View;

gpu_struct! {
    /// The view.
    pub struct Push: push of GRID_CELLS_VERT {
        clip_from_world: [[f32; 4]; 4],
    }
}

/// A cell: its corners, around, in the scene; its colour, linear BT.709, 0..1.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct GridCell {
    /// Metres.
    pub corners: [Vec3; 4],
    /// Display light.
    pub colour: Vec3,
}

/// What depends on the picture over which cells are drawn.
struct Target {
    copy: HandOver,
    pipeline: Pipeline,
    picture: Image,
}

/// The pass, and its picture.
pub struct GridCells {
    context: Arc<Context>,
    target: Option<Target>,
    table: Option<Buffer>,
    /// The cells in the table.
    cells: Vec<GridCell>,
}

impl GridCells {
    /// A pass without cells.
    pub fn new(context: &Arc<Context>) -> Self {
        Self {
            context: context.clone(),
            target: None,
            table: None,
            cells: Vec::new(),
        }
    }

    /// Draws cells over a copy of a picture of display values, behind the surfaces whose reversed depth is less than theirs.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources; there is no picture then.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        (display, depth): (&Image, &Image),
        view: &View,
        cells: Vec<GridCell>,
    ) -> Result<()> {
        self.follow(recorder, display)?;
        self.write(recorder, cells)?;
        let (Some(target), Some(table)) = (&self.target, &self.table) else {
            return Ok(());
        };
        let picture = &target.picture;
        target
            .copy
            .record(recorder, (display, display, picture), 0.0, 0);
        let push = Push {
            clip_from_world: view.clip_from_world().to_cols_array_2d(),
        };
        let count = self.cells.len() as u32;
        recorder
            .pass("grid cells", &target.pipeline)
            .storage("table", table)
            .sample("depth", depth, Sampler::Nearest)
            .push(&push)
            .color(picture, Load::Keep)
            .draws(|draws| draws.vertices(6 * count));
        Ok(())
    }

    /// The picture with the cells, once there is one.
    pub fn image(&self) -> Option<&Image> {
        self.target.as_ref().map(|target| &target.picture)
    }

    /// Makes the picture anew where size or format of the one below have changed; frames in flight may still use the old one.
    fn follow(&mut self, recorder: &mut Recorder, display: &Image) -> Result<()> {
        let (size, format) = (display.size(), display.format());
        let same = |t: &Target| t.picture.size() == size && t.picture.format() == format;
        if self.target.as_ref().is_some_and(same) {
            return Ok(());
        }
        if let Some(old) = self.target.take() {
            recorder.keep((old.copy, old.pipeline, old.picture));
        }
        let linear = is_linear(display);
        let desc = PipelineDesc {
            name: "grid cells",
            stages: &[&shaders::GRID_CELLS_VERT, &shaders::GRID_CELLS_FRAG],
            vertex: &[],
            colors: &[format],
            blend: Blend::Off,
            depth: Depth::Off,
            constants: &[("LINEAR", linear.into())],
        };
        let picture = ImageDesc::flat("picture with grid", format, size);
        self.target = Some(Target {
            copy: HandOver::new(&self.context, format, linear)?,
            pipeline: Pipeline::new(&self.context, &desc)?,
            picture: Image::new(&self.context, &picture.target_by(self.context.route()))?,
        });
        Ok(())
    }

    fn write(&mut self, recorder: &mut Recorder, cells: Vec<GridCell>) -> Result<()> {
        if cells == self.cells && self.table.is_some() {
            return Ok(());
        }
        let bytes: &[u8] = bytemuck::cast_slice(&cells);
        // Frames in flight may still read the old one.
        if let Some(old) = self.table.take() {
            recorder.keep(old);
        }
        let size = bytes.len().max(size_of::<GridCell>()) as u64;
        let table = Buffer::new(&self.context, "grid cells", BufferKind::Storage, size)?;
        if !cells.is_empty() {
            recorder.write(&table, bytes);
        }
        (self.table, self.cells) = (Some(table), cells);
        Ok(())
    }
}
