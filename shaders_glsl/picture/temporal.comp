#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// HALF: linear display values of an HDR screen.
// Variant: HALF
#include "fullscreen_compute.glsl"
#include "display_format.glsl"
#include "temporal.glsl"

layout(set = 0, binding = 40, DISPLAY_FORMAT) uniform writeonly image2DArray picture; // see temporal.glsl

void main() {
    if (!is_pixel_of(imageSize(picture).xy)) return;
    imageStore(picture, own_texel(), smoothed(pixel_centre()));
}
