#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "temporal.glsl"

layout(location = 0) out vec4 picture; // see temporal.glsl

void main() {
    picture = smoothed(gl_FragCoord.xy);
}
