#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// HALF: linear display values of an HDR screen.
// Variant: HALF
#include "fullscreen_compute.glsl"
#include "display_format.glsl"
#include "tone_map.glsl"

layout(set = 0, binding = 40, DISPLAY_FORMAT) uniform writeonly image2DArray display;

void main() {
    if (!is_pixel_of(imageSize(display).xy)) return;
    imageStore(display, own_texel(), shown(pixel_centre()));
}
