#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "accumulate.glsl"

layout(location = 0) out vec4 mean;

void main() {
    mean = mean_at(ivec2(gl_FragCoord.xy));
}
