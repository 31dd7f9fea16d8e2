//! Temporal anti-aliasing: the mean of the jittered frames of a moving view, in display values (Karis 2014, "High Quality Temporal Supersampling").
//!
//! The scene stands still, so depth and the two cameras tell where a surface was in the picture before ([`Reprojection`]). Whether the same surface
//! was seen there follows from depth too: two surfaces whose motion differs by less than an eighth of a pixel need not be told apart, so
//! no normals are compared. Where another was seen the picture before does not count. When the light has changed it is bounded by what is around the pixel
//! now, and counts for two frames.

use std::sync::Arc;

use glam::Vec2;

use crate::gpu::{
    Context, Depth, Format, Image, Load, Pipeline, Recorder, Result, Sampler, shaders,
};
use crate::gpu_struct;

use crate::passes::view::Reprojection;
use crate::passes::{Screen, screen};

/// Motion between two surfaces up to which they count as one, pixels.
const SAME: f32 = 0.125;

gpu_struct! {
    /// Motion since the picture before, and how much it counts.
    pub struct Push: push of TEMPORAL_FRAG, TEMPORAL_COMP, TEMPORAL_COMP_HALF {
        to_u: [f32; 4],
        to_v: [f32; 4],
        to_w: [f32; 4],
        half_texel: Vec2,
        to_depth: f32,
        same: f32,
        shift: f32,
        jitter: Vec2,
        axis: Vec2,
    }
}

/// What the pass reads.
pub struct Inputs<'a> {
    /// Display values of this frame, with whether the exposure is that of the frame before ([`super::tone_map`]).
    pub display: &'a Image,
    /// Reversed depth of this frame and of the one before.
    pub depths: [&'a Image; 2],
    /// The picture before; its contents count only with `motion`.
    pub before: &'a Image,
    /// Where surfaces were in the picture before; `None`: it does not count.
    pub motion: Option<Reprojection>,
    /// Offset of the sample of the frame before in the pixel, pixels ([`View::jitter`](crate::passes::view::View::jitter)).
    pub jitter: Vec2,
    /// Whether the light is that of the picture before.
    pub is_lit_alike: bool,
    /// Number of the frame.
    pub number: u32,
}

/// Number that differs from frame to frame, evenly spread over 0..1: multiples of the golden ratio.
pub(super) fn shift(number: u32) -> f32 {
    (f64::from(number) * 0.618_033_988_749_894_9).fract() as f32
}

/// The pass; its caller owns the pictures.
pub struct Temporal {
    /// For the light of the picture before, and for another.
    pipelines: [Pipeline; 2],
}

impl Temporal {
    /// Creates the pass for pictures of this format; `is_linear`: display values are linear, else encoded.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, format: Format, is_linear: bool) -> Result<Self> {
        let pipeline = |is_bounded: bool| {
            let constants = [("LINEAR", is_linear.into()), ("BOUNDED", is_bounded.into())];
            let shaders = Screen {
                fragment: &shaders::TEMPORAL_FRAG,
                compute: if is_linear {
                    &shaders::TEMPORAL_COMP_HALF
                } else {
                    &shaders::TEMPORAL_COMP
                },
            };
            let name = "temporal anti-aliasing";
            screen(context, name, shaders, &[format], Depth::Off, &constants)
        };
        Ok(Self {
            pipelines: [pipeline(false)?, pipeline(true)?],
        })
    }

    /// Adds a frame to the mean.
    pub fn record(&self, recorder: &mut Recorder, inputs: &Inputs<'_>, target: &Image) {
        let motion = inputs.motion.unwrap_or_default();
        let size = Vec2::from(inputs.display.size().map(|edge| edge as f32));
        let push = Push {
            to_u: motion.to_u.to_array(),
            to_v: motion.to_v.to_array(),
            to_w: motion.to_w.to_array(),
            half_texel: 0.5 / size,
            to_depth: motion.to_depth,
            // No depth differs by more than 1 from another.
            same: inputs
                .motion
                .map_or(-2.0, |motion| (SAME / motion.parallax).min(2.0)),
            shift: shift(inputs.number),
            jitter: inputs.jitter / size,
            axis: if inputs.number.is_multiple_of(2) {
                Vec2::X
            } else {
                Vec2::Y
            },
        };
        let [same_light, other_light] = &self.pipelines;
        let pipeline = if inputs.is_lit_alike {
            same_light
        } else {
            other_light
        };
        recorder
            .pass("temporal anti-aliasing", pipeline)
            .sample("display", inputs.display, Sampler::Nearest)
            .sample("depth", inputs.depths[0], Sampler::Nearest)
            .sample("before", inputs.before, Sampler::Linear)
            .sample("depth_before", inputs.depths[1], Sampler::Nearest)
            .push(&push)
            .output("picture", target, Load::Discard)
            .fill();
    }
}
