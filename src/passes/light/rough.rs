//! What all pipelines with lobes of GGX share.

use crate::daylight::microfacet::LEAST_ALPHA;

/// Constants of pipelines with `include/microfacet.glsl`: whether there are lobes, and a factor on what they reflect.
pub(in crate::passes) fn constants(has_any: bool, scale: f32) -> [(&'static str, u32); 3] {
    [
        ("ROUGH", has_any.into()),
        ("LOBE_SCALE", scale.to_bits()),
        ("LEAST_ALPHA", (LEAST_ALPHA as f32).to_bits()),
    ]
}
