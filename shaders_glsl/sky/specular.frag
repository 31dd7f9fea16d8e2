#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "specular.glsl"
#include "cube_fragment.glsl"

layout(location = 0) out vec4 specular_radiance; // kcd/m^2

void main() {
    specular_radiance = prefiltered(texel_direction());
}
