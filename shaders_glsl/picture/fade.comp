#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "fullscreen_compute.glsl"
#include "fade.glsl"

layout(set = 0, binding = 40, rgba32f) uniform writeonly image2DArray radiance; // as in fade.frag

void main() {
    if (!is_pixel_of(imageSize(radiance).xy)) return;
    imageStore(radiance, own_texel(), faded(own_pixel()));
}
