#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "irradiance.glsl"
#include "cube_fragment.glsl"

layout(location = 0) out vec4 sum;            // rgb: sum of pi L, klx; a: number of samples
layout(location = 1) out vec4 sky_irradiance; // E, klx

void main() {
    sum = refined(texel_direction(), ivec2(gl_FragCoord.xy), face);
    sky_irradiance = mean(sum);
}
