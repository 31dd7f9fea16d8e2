//! How the frames of an average are combined into a picture, and which lighting they use.

use std::sync::Arc;

use super::{AntiAliasing, FrameSettings, Visibility};
use crate::gpu::{Context, Image, Recorder, Result};
use crate::passes::bounces::cells::Cells;
use crate::passes::bounces::gather::Gather;
use crate::passes::bounces::tree::{Tree, TreeFacts};
use crate::passes::dome::gather::{Dome, Gathered};
use crate::passes::light::lighting::{Light, Lighting};
use crate::passes::picture::accumulate::Accumulate;
use crate::passes::picture::fade::Fade;
use crate::passes::sun_shadow::map::Shadow;
use crate::passes::surfaces::facts::Facts;
use crate::passes::surfaces::gbuffer::Surfaces;
use crate::passes::surfaces::geometry::Geometry;
use crate::passes::view::View;

/// The sun's shadow and the lighting of a frame.
pub(super) struct Lit {
    pub shadow: Shadow,
    pub lighting: Lighting,
}

/// How the frames of an average are combined into a picture.
pub(super) enum Average {
    /// Each frame is a picture.
    None,
    /// The plain mean of the frames.
    Mean(Box<Accumulate>),
    /// Means that converge to the true visibility of the sky.
    Dome(Box<Converging>),
}

/// The passes of [`Visibility::Dome`] and [`Visibility::Progressive`].
pub(super) struct Converging {
    /// Hard shadows, and all light except diffuse sky light.
    lit: Lit,
    /// Light from other surfaces, if it is shown.
    gather: Option<Gather>,
    /// Diffuse sky light, and the means.
    dome: Dome,
    /// Cross-fade from the preview to the means, unless display values fade.
    fade: Option<Fade>,
    /// Whether the newest frame was a preview.
    is_previewed: bool,
}

impl Average {
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(
        context: &Arc<Context>,
        facts: &Facts,
        tree: &TreeFacts,
        settings: &FrameSettings,
    ) -> Result<Self> {
        let size = settings.size.to_array();
        if settings.takes_mean() {
            let mean = Accumulate::new(context, size)?;
            return Ok(Self::Mean(Box::new(mean)));
        }
        if !settings.converges() {
            return Ok(Self::None);
        }
        let (sampling, lighting) = (&settings.sampling, settings.lighting);
        let fades = sampling.visibility == Visibility::Progressive
            && settings.anti_aliasing() == AntiAliasing::Off;
        let bounces = settings.gathered();
        Ok(Self::Dome(Box::new(Converging {
            lit: Lit {
                shadow: Shadow::perspective(
                    context,
                    facts,
                    settings.shadow_resolution,
                    lighting.sun_by_rays,
                )?,
                lighting: Lighting::converging(context, tree.constants(), size, lighting)?,
            },
            gather: bounces
                .is_any()
                .then(|| Gather::new(context, tree, size, bounces))
                .transpose()?,
            dome: Dome::new(
                context,
                (facts, tree),
                size,
                sampling.dome,
                lighting,
                bounces,
            )?,
            fade: fades
                .then(|| Fade::new(context, size, settings.samples))
                .transpose()?,
            is_previewed: false,
        })))
    }

    /// Whether the new settings need a new average.
    pub fn is_changed(old: &FrameSettings, new: &FrameSettings) -> bool {
        let of = |s: &FrameSettings| {
            let of_dome = (
                s.samples,
                s.sampling,
                s.lighting,
                s.shadow_resolution,
                s.gathered(),
                s.anti_aliasing() == AntiAliasing::Off,
            );
            (s.size, s.takes_mean(), s.converges().then_some(of_dome))
        };
        of(old) != of(new)
    }

    /// Shadow map and lighting of frame number `index` of an average, and how the frame is resolved. `None` is a preview.
    pub fn frame<'a>(
        &'a mut self,
        preview: &'a mut Lit,
        index: Option<u32>,
    ) -> (&'a mut Lit, Resolve<'a>) {
        match (self, index) {
            (Self::Dome(converging), Some(index)) => {
                let Converging {
                    lit,
                    gather,
                    dome,
                    fade,
                    is_previewed,
                } = &mut **converging;
                let from = (preview.lighting.image(), std::mem::take(is_previewed));
                let fade = fade.as_mut().map(|fade| (fade, from));
                let gather = gather.as_mut();
                (
                    lit,
                    Resolve::Dome {
                        gather,
                        dome,
                        fade,
                        index,
                    },
                )
            }
            (Self::Dome(converging), None) => {
                converging.is_previewed = true;
                (preview, Resolve::None)
            }
            (Self::Mean(mean), Some(index)) => (preview, Resolve::Mean(mean, index)),
            _ => (preview, Resolve::None),
        }
    }

    /// The newest picture, kcd/m²; `None` if each frame is a picture of its own.
    pub fn image(&self) -> Option<&Image> {
        match self {
            Self::None => None,
            Self::Mean(mean) => Some(mean.image()),
            Self::Dome(c) => Some(c.fade.as_ref().map_or(c.dome.image(), Fade::image)),
        }
    }
}

/// How one frame is resolved into the picture.
pub(super) enum Resolve<'a> {
    /// The frame is the picture.
    None,
    /// The frame is added to a mean under this number.
    Mean(&'a mut Accumulate, u32),
    /// The frame is added to the means of the dome; the picture cross-fades from a preview.
    Dome {
        gather: Option<&'a mut Gather>,
        dome: &'a mut Dome,
        /// The cross-fade, the preview, and whether the previous frame was a preview.
        fade: Option<(&'a mut Fade, (&'a Image, bool))>,
        index: u32,
    },
}

impl<'a> Resolve<'a> {
    /// Whether the dome adds the diffuse sky light.
    pub fn is_dome(&self) -> bool {
        matches!(self, Self::Dome { .. })
    }

    /// Whether rays gather the light of other surfaces.
    pub fn gathers(&self) -> bool {
        matches!(
            self,
            Self::Dome {
                gather: Some(_),
                ..
            }
        )
    }

    /// Records the resolve and returns the picture after this frame.
    pub fn record(
        self,
        rec: &mut Recorder,
        (geometry, tree, cells): (&Geometry, &Tree, Option<&Cells>),
        frame: &'a Image,
        surfaces: &Surfaces,
        light: &Light<'_>,
        view: &View,
    ) -> &'a Image {
        match self {
            Self::None => frame,
            Self::Mean(mean, index) => mean.record(rec, frame, index),
            Self::Dome {
                gather,
                dome,
                fade,
                index,
            } => {
                let bounced = gather.zip(cells).map(|(gather, cells)| {
                    gather.record(rec, (tree, cells), surfaces, light.daylight, view, index)
                });
                let gathered = Gathered {
                    surfaces,
                    materials: geometry.materials(),
                    frame,
                    sky_irradiance: light.sky_irradiance,
                    sky_radiance: light.sky_radiance,
                    panes: light.panes,
                    air: light.air,
                    bounced,
                };
                let picture = dome.record(
                    rec,
                    (geometry, tree),
                    &gathered,
                    light.daylight,
                    view,
                    index,
                );
                match fade {
                    Some((fade, (preview, is_previewed))) => {
                        fade.record(rec, preview, picture, index, is_previewed)
                    }
                    None => picture,
                }
            }
        }
    }
}
