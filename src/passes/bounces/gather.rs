//! Bounced light of converging frames: rays from the pixels, lit where they end by the sun and the cells.

use std::sync::Arc;

use glam::{IVec2, Vec2};

use crate::daylight::sky::Daylight;
use crate::gpu::{Context, Format, Image, ImageDesc, Pipeline, Recorder, Result, Sampler, shaders};
use crate::gpu_struct;
use crate::passes::bounces::cells::{Bounces, Cells};
use crate::passes::bounces::tree::{Tree, TreeFacts};
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

gpu_struct! {
    /// What the filter needs to know of the picture.
    pub struct FilterPush: push of BOUNCES_FILTER_COMP {
        chosen: IVec2,
        size: Vec2,
        step: i32,
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

/// The gathering pass, its filter, and their images.
pub struct Gather {
    pipeline: Pipeline,
    filter: Pipeline,
    bounced: Image,
    smoothed: Image,
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
        tree: &TreeFacts,
        size: [u32; 2],
        bounces: Bounces,
    ) -> Result<Self> {
        let image = |name| {
            let desc = ImageDesc::flat(name, HALF_SIZE, half_size(size));
            Image::new(context, &desc.stored())
        };
        Ok(Self {
            pipeline: compute(
                context,
                "bounces: gather",
                &shaders::BOUNCES_GATHER_COMP,
                &tree.constants_with_emitters(),
            )?,
            filter: compute(
                context,
                "bounces: filter",
                &shaders::BOUNCES_FILTER_COMP,
                &[],
            )?,
            bounced: image("bounced irradiance")?,
            smoothed: image("bounced irradiance, smoothed")?,
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
        let set = of_pair / FRAMES_OF_RAYS;
        let (chosen, steps) = (chosen(set), steps(set, view.whole().size.y));
        if of_pair == index || self.traced != Some(of_pair) {
            self.traced = Some(of_pair);
            let pass = recorder.pass("bounces: gather", &self.pipeline);
            let pass = cells.bound_to(tree.bound_with_emitters(pass));
            surfaces
                .shapes_sampled_by(pass)
                .uniform("view", &view.block())
                .uniform("scene", &cells.block(view, daylight))
                .push(&Push {
                    index: set,
                    origin,
                    chosen,
                    share: if self.blends { share(of_pair) } else { 1.0 },
                })
                .store("bounced", &self.bounced)
                .dispatch();
            self.smooth(recorder, surfaces, view, chosen, steps);
        }
        let [image, _] = self.images(steps.len());
        HalfSize { image, chosen }
    }

    /// The image that holds the light after some passes of the filter, and the other one.
    fn images(&self, passes: usize) -> [&Image; 2] {
        let pair = [&self.bounced, &self.smoothed];
        [pair[passes % 2], pair[(passes + 1) % 2]]
    }

    /// Filters the light of the rays, once for each distance between the texels of the kernel.
    fn smooth(
        &self,
        recorder: &mut Recorder,
        surfaces: &Surfaces,
        view: &View,
        chosen: IVec2,
        steps: &[i32],
    ) {
        let [width, height] = surfaces.depth.size();
        for (pass, &step) in steps.iter().enumerate() {
            let [from, to] = self.images(pass);
            recorder
                .pass("bounces: filter", &self.filter)
                .sample("bounced", from, Sampler::Nearest)
                .uniform("view", &view.block())
                .push(&FilterPush {
                    chosen,
                    size: Vec2::new(width as f32, height as f32),
                    step,
                })
                .store("smoothed", to)
                .dispatch();
        }
    }
}

/// Frames after which rays and cells have the same weight in the mean: the error of the cells is about the noise of so many
/// filtered rays.
const EVEN: f32 = 12.0;

/// The share of the rays in the light of frame number `index`. Over n frames the mean of the shares is n / (n + EVEN): the picture
/// starts with the light of the cells, which is smooth, and ends with that of the rays, which is exact.
fn share(index: u32) -> f32 {
    let n = index as f32;
    n * (n + 2.0 * EVEN) / ((n + EVEN) * (n + EVEN))
}

/// Frames that share rays: a frame costs about as much as its rays, and bounced light varies less than the rest.
const FRAMES_OF_RAYS: u32 = 2;

/// Rows of a picture for a texel between those of the filter's kernel: at most so wide a part of the picture is blurred.
const ROWS_OF_STEP: u32 = 120;

/// Distances between the texels of the kernel in the passes of the filter for set number `index` of rays, in a picture of so many
/// rows. The first sets are spread widely, against noise; the later ones less and then not at all, so that the mean converges to
/// the exact light.
fn steps(index: u32, rows: u32) -> &'static [i32] {
    let step = match index {
        0..8 => 3,
        8..24 => 2,
        24..64 => 1,
        _ => 0,
    };
    // A step of one closes the gaps that a wide one leaves.
    match step.min(rows / ROWS_OF_STEP) {
        0 => &[],
        1 => &[1],
        2 => &[2, 1],
        _ => &[3, 1],
    }
}

/// The pixel of each square that set number `index` of rays is for: each in turn, first along a diagonal.
fn chosen(index: u32) -> IVec2 {
    let turn = [IVec2::ZERO, IVec2::ONE, IVec2::X, IVec2::Y];
    turn[index as usize % turn.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_filter_narrows_and_ends() {
        let widest = |index, rows| steps(index, rows).first().copied().unwrap_or(0);
        let over_time = [0, 8, 24, 64].map(|index| widest(index, 1080));
        assert_eq!(over_time, [3, 2, 1, 0]);
        assert_eq!([64, 120, 300].map(|rows| widest(0, rows)), [0, 1, 2]);
    }

    #[test]
    fn the_rays_take_over() {
        let mean = |n: u32| (0..n).map(share).sum::<f32>() / n as f32;
        assert_eq!(share(0), 0.0);
        assert!((mean(12) - 0.5).abs() < 0.05, "{}", mean(12));
        assert!((mean(120) - 10.0 / 11.0).abs() < 0.01, "{}", mean(120));
    }
}
