#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "irradiance_exact.glsl"
#include "cube_compute.glsl"

layout(set = 0, binding = 2, rgba32f) uniform writeonly image2DArray sum;            // E, klx; a: 1
layout(set = 0, binding = 3, rgba32f) uniform writeonly image2DArray sky_irradiance; // E, klx

void main() {
    ivec2 size = imageSize(sum).xy;
    if (!is_texel_of(size)) return;
    ivec3 texel = cube_texel();
    vec4 total = summed(texel_direction(size));
    imageStore(sum, texel, total);
    imageStore(sky_irradiance, texel, total);
}
