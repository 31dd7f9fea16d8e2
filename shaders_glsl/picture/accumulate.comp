#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "fullscreen_compute.glsl"
#include "accumulate.glsl"

layout(set = 0, binding = 40, rgba32f) uniform writeonly image2DArray mean;

void main() {
    if (!is_pixel_of(imageSize(mean).xy)) return;
    imageStore(mean, own_texel(), mean_at(own_pixel()));
}
