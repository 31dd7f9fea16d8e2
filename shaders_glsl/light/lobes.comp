#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// CELLS: surfaces that rays meet have light.
// Variant: CELLS
#include "fullscreen_compute.glsl"
#include "lobes.glsl"

layout(set = 0, binding = 40, rgba32f) uniform writeonly image2DArray light; // as in lobes.frag

void main() {
    if (!is_pixel_of(imageSize(light).xy)) return;
    imageStore(light, own_texel(), in_lobes(pixel_centre()));
}
