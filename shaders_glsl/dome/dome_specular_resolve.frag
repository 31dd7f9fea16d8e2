#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "dome_specular_resolve.glsl"

layout(location = 0) out vec4 radiance; // rgb: kcd/m^2; a: that of the picture

void main() {
    radiance = with_reflection(gl_FragCoord.xy);
}
