//! What a frame has besides its usual passes when its sky is to converge to the truth.

use std::sync::Arc;

use super::{FrameSettings, Visibility};
use crate::gpu::{Context, Image, Result};
use crate::passes::dome::gather::Dome;
use crate::passes::light::lighting::Lighting;
use crate::passes::picture::fade::Fade;
use crate::passes::sun_shadow::map::Shadow;
use crate::passes::surfaces::geometry::Geometry;

/// The passes of [`Visibility::Dome`] and [`Visibility::Progressive`].
pub(super) struct Converging {
    /// The sun's map for hard shadows.
    pub shadow: Shadow,
    /// All light but the diffuse light of the sky.
    pub lighting: Lighting,
    /// That, and the means.
    pub dome: Dome,
    /// From the preview to that.
    pub fade: Option<Fade>,
}

impl Converging {
    /// Nothing when the frame does not converge.
    pub fn new(
        context: &Arc<Context>,
        geometry: &Geometry,
        settings: &FrameSettings,
    ) -> Result<Option<Self>> {
        let sampling = &settings.sampling;
        if !settings.converges() {
            return Ok(None);
        }
        let size = settings.size.to_array();
        let fades = sampling.visibility == Visibility::Progressive;
        Ok(Some(Self {
            shadow: Shadow::unbiased(context, geometry, settings.shadow_resolution)?,
            lighting: Lighting::converging(context, size, settings.lighting)?,
            dome: Dome::new(context, geometry, size, sampling.dome, settings.lighting)?,
            fade: fades
                .then(|| Fade::new(context, size, settings.samples))
                .transpose()?,
        }))
    }

    /// The newest picture, kcd/m².
    pub fn image(&self) -> &Image {
        self.fade.as_ref().map_or(self.dome.image(), Fade::image)
    }

    /// Whether new settings need other passes.
    pub fn is_changed(old: &FrameSettings, new: &FrameSettings) -> bool {
        let of = |s: &FrameSettings| {
            (
                s.size,
                s.samples,
                s.sampling,
                s.lighting,
                s.shadow_resolution,
            )
        };
        of(old) != of(new)
    }
}
