//! What a frame has besides its usual passes when its sky is to converge to the truth.

use std::sync::Arc;

use super::{FrameSettings, Visibility};
use crate::gpu::{Context, Result};
use crate::passes::dome::Dome;
use crate::passes::geometry::Geometry;
use crate::passes::lighting::Lighting;
use crate::passes::shadow::Shadow;

/// The passes of [`Visibility::Dome`] and [`Visibility::Progressive`].
pub(super) struct Converging {
    /// The sun's map for hard shadows.
    pub shadow: Shadow,
    /// All light but the diffuse light of the sky.
    pub lighting: Lighting,
    /// That, and the means.
    pub dome: Dome,
}

impl Converging {
    /// Nothing when the frame does not converge.
    pub fn new(
        context: &Arc<Context>,
        geometry: &Geometry,
        settings: &FrameSettings,
    ) -> Result<Option<Self>> {
        let sampling = &settings.sampling;
        if sampling.visibility == Visibility::Ssao {
            return Ok(None);
        }
        let size = settings.size.to_array();
        let downscale = settings.lighting.occlusion_downscale;
        let prior = (sampling.visibility == Visibility::Progressive).then_some(downscale);
        Ok(Some(Self {
            shadow: Shadow::unbiased(context, geometry, settings.shadow_resolution)?,
            lighting: Lighting::converging(context, size, settings.lighting)?,
            dome: Dome::new(
                context,
                geometry,
                size,
                sampling.dome,
                settings.lighting,
                prior,
            )?,
        }))
    }

    /// Whether new settings need other passes.
    pub fn is_changed(old: &FrameSettings, new: &FrameSettings) -> bool {
        let of = |s: &FrameSettings| (s.size, s.sampling, s.lighting, s.shadow_resolution);
        of(old) != of(new)
    }
}
