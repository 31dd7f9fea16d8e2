#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "dome_resolve.glsl"

layout(location = 0) out vec4 radiance; // rgb: kcd/m^2, or the quantity shown; a: with ILLUMINANCE, that of the surface, klx

void main() {
    radiance = resolved(gl_FragCoord.xy);
}
