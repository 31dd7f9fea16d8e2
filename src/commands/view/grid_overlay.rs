//! The cells of the desk's sensors over the picture.

use std::sync::Arc;

use super::desk::Desk;
use super::desk::metric::Metric;
use crate::daylight::colour::srgb_eotf;
use crate::daylight::false_colour::ColourMap;
use crate::frame::Frame;
use crate::gpu::{Context, Image, Recorder, Result};
use crate::passes::picture::grid_cells::{GridCell, GridCells};
use crate::passes::view::View;
use crate::scene::Camera;
use glam::{DVec3, Vec2};

/// What the cells were drawn of: the desk's revision, the metric, the hour of the weather file, the colours.
type Key = (u64, Metric, Option<usize>, ColourMap);

/// The pass, and what it has drawn.
pub(super) struct GridOverlay {
    cells: GridCells,
    /// `None`: the picture is shown without cells.
    drawn: Option<Key>,
}

impl GridOverlay {
    pub(super) fn new(context: &Arc<Context>) -> Self {
        Self {
            cells: GridCells::new(context),
            drawn: None,
        }
    }

    /// Draws the cells of a desk over the frame's picture, seen by this camera. Does nothing where neither picture (`is_new`) nor values changed.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub(super) fn record(
        &mut self,
        recorder: &mut Recorder,
        desk: Option<&Desk>,
        (frame, camera): (&Frame, Option<Camera>),
        (record, map): (Option<usize>, ColourMap),
        is_new: bool,
    ) -> Result<()> {
        let (Some(desk), Some(camera)) = (desk, camera) else {
            self.drawn = None;
            return Ok(());
        };
        let key = (desk.revision(), desk.metric, record, map);
        if !is_new && self.drawn == Some(key) {
            return Ok(());
        }
        self.drawn = None;
        let Some(values) = desk.values(record, map) else {
            return Ok(());
        };
        let cell = |(sensor, corners): (usize, [glam::Vec3; 4])| {
            let value = values.column.values.get(sensor).filter(|v| v.is_finite())?;
            let bytes = values.scale.ink(values.scale.share(*value)).0;
            let colour = DVec3::from(bytes.map(|b| f64::from(b) / 255.0)).map(srgb_eotf);
            Some(GridCell {
                corners,
                colour: colour.as_vec3(),
            })
        };
        let view = View {
            camera,
            size: frame.settings().size,
            jitter: Vec2::ZERO,
            sharpen: 0.0,
            window: None,
        };
        let cells = desk.cells().filter_map(cell).collect();
        let below = (frame.display(), frame.depth());
        self.cells.record(recorder, below, &view, cells)?;
        self.drawn = Some(key);
        Ok(())
    }

    /// The picture with the cells, if they are shown.
    pub(super) fn image(&self) -> Option<&Image> {
        self.drawn.and(self.cells.image())
    }
}
