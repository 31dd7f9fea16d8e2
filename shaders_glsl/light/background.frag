#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "background.glsl"

layout(location = 0) out vec4 radiance; // rgb: kcd/m^2, or a constant; a: 0;

void main() {
    // The depth test passes only pixels without a surface.
    radiance = behind(gl_FragCoord.xy);
}
