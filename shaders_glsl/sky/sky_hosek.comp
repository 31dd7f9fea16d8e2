#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "sky_hosek.glsl"
#include "cube_compute.glsl"

layout(set = 0, binding = 1, rgba32f) uniform writeonly image2DArray sky_radiance; // kcd/m^2

void main() {
    ivec2 size = imageSize(sky_radiance).xy;
    if (is_texel_of(size)) imageStore(sky_radiance, cube_texel(), sky(texel_direction(size)));
}
