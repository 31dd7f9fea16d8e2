//! Where single frames have the light of the sky and of the bounces from.

use std::sync::Arc;

use super::{FrameSettings, Visibility};
use crate::gpu::{Context, Result};
use crate::passes::bounces::ambient::CellLight;
use crate::passes::light::lighting::Ambient;
use crate::passes::occlusion::height_map::HeightMap;
use crate::passes::occlusion::ssao::{Ssao, SsaoSettings};
use crate::passes::surfaces::geometry::Geometry;

/// The passes of one of the sources.
pub(super) enum AmbientPasses {
    /// There are no single frames.
    None,
    /// Screen-space ambient occlusion of the unoccluded sky.
    Screen(Box<Screen>),
    /// The cells.
    Cells(CellLight),
}

/// The passes of screen-space ambient occlusion.
pub(super) struct Screen {
    pub heights: HeightMap,
    pub ssao: Ssao,
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

impl AmbientPasses {
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(
        context: &Arc<Context>,
        geometry: &Geometry,
        settings: &FrameSettings,
    ) -> Result<Self> {
        let size = settings.size.to_array();
        Ok(match AmbientNeed::of(settings) {
            AmbientNeed::None => Self::None,
            AmbientNeed::Screen(ssao) => Self::Screen(Box::new(Screen {
                heights: HeightMap::new(context, geometry)?,
                ssao: Ssao::new(context, size, ssao)?,
            })),
            AmbientNeed::Cells => Self::Cells(CellLight::new(context, size)?),
        })
    }
}
