#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lighting.glsl"

layout(location = 0) out vec4 radiance; // rgb: kcd/m^2, or the quantity shown; a: illuminance of the surface, klx;

void main() {
    // The depth test passes only pixels with a surface.
    radiance = lit(gl_FragCoord.xy);
}
