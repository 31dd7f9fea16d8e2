#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// FLOAT: the picture has 32-bit floats.
// Variant: FLOAT
#include "fullscreen_compute.glsl"
#include "background.glsl"

layout(set = 0, binding = 39) uniform sampler2D depth;
layout(set = 0, binding = 40, PICTURE_FORMAT) uniform writeonly image2DArray radiance; // as in background.frag

void main() {
    if (!is_pixel_of(imageSize(radiance).xy)) return;
    // Pixels with a surface are kept.
    if (texelFetch(depth, own_pixel(), 0).r != 0.0) return;
    imageStore(radiance, own_texel(), behind(pixel_centre()));
}
