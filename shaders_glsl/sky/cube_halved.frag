#version 460
#extension GL_GOOGLE_include_directive : require
#include "cube_halved.glsl"
#include "cube_fragment.glsl"

layout(location = 0) out vec4 coarser;

void main() {
    coarser = halved(face, ivec2(gl_FragCoord.xy));
}
