#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// HALF: linear display values of an HDR screen.
// Variant: HALF
#include "fullscreen_compute.glsl"
#include "tone_map.glsl"

#ifdef HALF
#define DISPLAY_FORMAT rgba16f
#else
#define DISPLAY_FORMAT rgba8
#endif

layout(set = 0, binding = 40, DISPLAY_FORMAT) uniform writeonly image2DArray display;

void main() {
    if (!is_pixel_of(imageSize(display).xy)) return;
    imageStore(display, own_texel(), shown(pixel_centre()));
}
