//! Bounced light of converging frames: rays from the pixels, lit where they end by the sun and the cells.

use std::sync::Arc;

use glam::IVec2;

use crate::daylight::sky::Daylight;
use crate::gpu::{Context, Format, Image, ImageDesc, Pipeline, Recorder, Result, shaders};
use crate::gpu_struct;
use crate::passes::bounces::cells::{Bounces, Cells};
use crate::passes::bounces::tree::Tree;
use crate::passes::compute;
use crate::passes::surfaces::gbuffer::Surfaces;
use crate::passes::view::View;

gpu_struct! {
    /// Number of the frame and position of the picture.
    pub struct Push: push of BOUNCES_GATHER_COMP {
        index: u32,
        origin: IVec2,
        chosen: IVec2,
        share: f32,
    }
}

/// Irradiance at half the size of the picture, see `include/half_size.glsl`.
#[derive(Clone, Copy)]
pub struct HalfSize<'a> {
    /// One texel for each square of two by two pixels.
    pub image: &'a Image,
    /// The pixel of each square that has the texel.
    pub chosen: IVec2,
}

/// The size of an image of a texel per square of two by two pixels.
pub(in crate::passes) fn half_size(size: [u32; 2]) -> [u32; 2] {
    size.map(|edge| edge.div_ceil(2))
}

/// The format of such an image.
pub(in crate::passes) const HALF_SIZE: Format = Format::R32G32B32A32_UINT;

/// The gathering pass and its image.
pub struct Gather {
    pipeline: Pipeline,
    bounced: Image,
    /// The last frame that traced rays.
    traced: Option<u32>,
    /// Whether the cells hold the same bounces as the rays bring.
    blends: bool,
}

impl Gather {
    /// Creates the pass for pictures of `size` pixels.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(
        context: &Arc<Context>,
        tree: &Tree,
        size: [u32; 2],
        bounces: Bounces,
    ) -> Result<Self> {
        let desc = ImageDesc::flat("bounced irradiance", HALF_SIZE, half_size(size));
        Ok(Self {
            pipeline: compute(
                context,
                "bounces: gather",
                &shaders::BOUNCES_GATHER_COMP,
                &tree.constants_with_emitters(),
            )?,
            bounced: Image::new(context, &desc.stored())?,
            traced: None,
            blends: bounces == Bounces::All,
        })
    }

    /// Traces a ray per square of pixels for frame number `index` of an average, or for the one before, and returns the irradiance
    /// of the light that they bring, klx.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        (tree, cells): (&Tree, &Cells),
        surfaces: &Surfaces,
        daylight: &Daylight,
        view: &View,
        index: u32,
    ) -> HalfSize<'_> {
        let origin = view.window.map_or(IVec2::ZERO, |w| w.origin.as_ivec2());
        let of_pair = index - index % FRAMES_OF_RAYS;
        let chosen = chosen(of_pair / FRAMES_OF_RAYS);
        if of_pair < index && self.traced == Some(of_pair) {
            return HalfSize {
                image: &self.bounced,
                chosen,
            };
        }
        self.traced = Some(of_pair);
        let pass = recorder.pass("bounces: gather", &self.pipeline);
        let pass = cells.bound_to(tree.bound_with_emitters(pass));
        surfaces
            .shapes_sampled_by(pass)
            .uniform("view", &view.block())
            .uniform("scene", &cells.block(view, daylight))
            .push(&Push {
                index: of_pair / FRAMES_OF_RAYS,
                origin,
                chosen,
                share: if self.blends { share(of_pair) } else { 1.0 },
            })
            .store("bounced", &self.bounced)
            .dispatch();
        HalfSize {
            image: &self.bounced,
            chosen,
        }
    }
}

/// Frames after which rays and cells have the same weight in the mean: the error of the cells is about the noise of so many rays.
const EVEN: f32 = 32.0;

/// The share of the rays in the light of frame number `index`. Over n frames the mean of the shares is n / (n + EVEN): the picture
/// starts with the light of the cells, which is smooth, and ends with that of the rays, which is exact.
fn share(index: u32) -> f32 {
    let n = index as f32;
    n * (n + 2.0 * EVEN) / ((n + EVEN) * (n + EVEN))
}

/// Frames that share rays: a frame costs about as much as its rays, and bounced light varies less than the rest.
const FRAMES_OF_RAYS: u32 = 2;

/// The pixel of each square that set number `index` of rays is for: each in turn, first along a diagonal.
fn chosen(index: u32) -> IVec2 {
    let turn = [IVec2::ZERO, IVec2::ONE, IVec2::X, IVec2::Y];
    turn[index as usize % turn.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rays_take_over() {
        let mean = |n: u32| (0..n).map(share).sum::<f32>() / n as f32;
        assert_eq!(share(0), 0.0);
        assert!((mean(32) - 0.5).abs() < 0.02, "{}", mean(32));
        assert!((mean(320) - 10.0 / 11.0).abs() < 0.01, "{}", mean(320));
    }
}
