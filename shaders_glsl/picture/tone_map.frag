#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "tone_map.glsl"

layout(location = 0) out vec4 display; // a: 0 if the exposure is not nearly that of the picture before

void main() {
    display = shown(gl_FragCoord.xy);
}
