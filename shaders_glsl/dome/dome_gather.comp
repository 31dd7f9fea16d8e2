#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// ILLUMINANCE: the illuminance of surfaces too, whatever is shown.
// Variant: ILLUMINANCE
#include "fullscreen_compute.glsl"
#include "dome_gather.glsl"

// See dome_gather.glsl.
layout(set = 0, binding = 40, rgba32f) uniform writeonly image2DArray new_sky;
layout(set = 0, binding = 41, rgba32f) uniform writeonly image2DArray new_rest;
#ifdef ILLUMINANCE
layout(set = 0, binding = 42, rgba32f) uniform writeonly image2DArray new_illuminance;
#endif

void main() {
    if (!is_pixel_of(imageSize(new_sky).xy)) return;
    gather_at(pixel_centre());
    imageStore(new_sky, own_texel(), sky);
    imageStore(new_rest, own_texel(), rest);
#ifdef ILLUMINANCE
    imageStore(new_illuminance, own_texel(), illuminance);
#endif
}
