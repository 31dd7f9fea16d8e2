#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "dome_specular.glsl"

// See dome_specular.glsl.
layout(location = 0) out vec4 new_reflected;
layout(location = 1) out float new_lobe;

void main() {
    reflect_at(gl_FragCoord.xy);
    new_reflected = reflected;
    new_lobe = lobe;
}
