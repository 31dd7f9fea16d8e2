#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "tone_map.glsl"

layout(location = 0) out vec4 display;

void main() {
    display = shown(gl_FragCoord.xy);
}
