//! Where single frames have the light of the sky and of the bounces from.

use std::sync::Arc;

use super::{FrameSettings, Visibility};
use crate::daylight::sky::Daylight;
use crate::gpu::{Context, Image, Recorder, Result};
use crate::passes::bounces::ambient::CellLight;
use crate::passes::bounces::cells::Cells;
use crate::passes::light::lighting::Ambient;
use crate::passes::occlusion::ssao::{Ssao, SsaoSettings};
use crate::passes::surfaces::gbuffer::Surfaces;
use crate::passes::view::View;

/// The passes of one of the sources.
pub(super) enum AmbientPasses {
    /// There are no single frames.
    None,
    /// Screen-space ambient occlusion of the unoccluded sky.
    Screen(Box<Ssao>),
    /// The cells.
    Cells(Box<CellLight>),
}

/// What the passes depend on besides the size of the picture.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum AmbientNeed {
    None,
    Screen(SsaoSettings),
    Cells,
}

impl AmbientNeed {
    /// What frames with these settings need.
    pub fn of(settings: &FrameSettings) -> Self {
        if settings.sampling.visibility == Visibility::Dome {
            return Self::None;
        }
        match settings.lighting.ambient {
            Ambient::Ssao => Self::Screen(settings.ssao),
            Ambient::Cells => Self::Cells,
        }
    }
}

/// The images that may be read for it.
pub(super) struct AmbientInputs<'a> {
    pub surfaces: &'a Surfaces,
    pub daylight: &'a Daylight,
    pub view: &'a View,
    pub cells: Option<&'a Cells>,
    /// Occlusion of the whole picture, if it is shared by tiles.
    pub of_picture: Option<&'a Image>,
    /// Phase of the noise of occlusion, 0..1.
    pub phase: f32,
}

impl AmbientPasses {
    /// Records the passes and returns what the lighting reads; any image if it reads none, as in frames of the dome.
    pub fn record<'a>(
        &'a mut self,
        rec: &mut Recorder,
        inputs: &AmbientInputs<'a>,
        is_dome: bool,
    ) -> &'a Image {
        let (surfaces, view) = (inputs.surfaces, inputs.view);
        if is_dome {
            return &surfaces.normal_material;
        }
        match (self, inputs.cells) {
            (Self::Cells(pass), Some(cells)) => {
                pass.record(rec, cells, surfaces, inputs.daylight, view)
            }
            (Self::Screen(ssao), _) => inputs
                .of_picture
                .unwrap_or_else(|| ssao.record(rec, surfaces, view, inputs.phase)),
            _ => &surfaces.normal_material,
        }
    }

    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, settings: &FrameSettings) -> Result<Self> {
        let size = settings.size.to_array();
        Ok(match AmbientNeed::of(settings) {
            AmbientNeed::None => Self::None,
            AmbientNeed::Screen(ssao) => Self::Screen(Box::new(Ssao::new(context, size, ssao)?)),
            AmbientNeed::Cells => Self::Cells(Box::new(CellLight::new(context, size)?)),
        })
    }
}
