#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "fade.glsl"

layout(location = 0) out vec4 radiance; // rgb: kcd/m^2, or the quantity shown; a: illuminance, klx

void main() {
    radiance = faded(ivec2(gl_FragCoord.xy));
}
