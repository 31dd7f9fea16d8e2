#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "triangles_push.glsl"

layout(location = 0) out uint triangle; // its number in the index buffer, from 1 on

void main() {
    triangle = push.first + uint(gl_PrimitiveID) + 1u;
}
