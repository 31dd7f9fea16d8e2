#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "irradiance_exact.glsl"
#include "cube_fragment.glsl"

layout(location = 0) out vec4 sum;            // E, klx; a: 1
layout(location = 1) out vec4 sky_irradiance; // E, klx

void main() {
    sum = summed(texel_direction());
    sky_irradiance = sum;
}
