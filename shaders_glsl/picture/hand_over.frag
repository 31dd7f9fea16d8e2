#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hand_over.glsl"

layout(location = 0) out vec4 picture; // see hand_over.glsl

void main() {
    picture = handed_over(gl_FragCoord.xy);
}
