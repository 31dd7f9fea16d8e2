#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// ILLUMINANCE: the illuminance of surfaces too, whatever is shown.
// Variant: ILLUMINANCE
#include "dome_gather.glsl"

// See dome_gather.glsl.
layout(location = 0) out vec4 new_sky;
layout(location = 1) out vec4 new_rest;
#ifdef ILLUMINANCE
layout(location = 2) out vec4 new_illuminance;
#endif

void main() {
    gather_at(gl_FragCoord.xy);
    new_sky = sky;
    new_rest = rest;
#ifdef ILLUMINANCE
    new_illuminance = illuminance;
#endif
}
