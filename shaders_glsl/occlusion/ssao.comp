#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "fullscreen_compute.glsl"
#include "ssao.glsl"

layout(set = 0, binding = 40, r32ui) uniform writeonly uimage2DArray occlusion; // as in ssao.frag

void main() {
    if (!is_pixel_of(imageSize(occlusion).xy)) return;
    // A word of 0 is A = 1 at distance 0.
    uint word = 0u;
    if (is_surface_at(own_pixel())) word = slice_at(own_pixel());
    imageStore(occlusion, own_texel(), uvec4(word));
}
