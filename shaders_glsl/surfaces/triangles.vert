#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "triangles_push.glsl"

layout(location = 0) in vec3 position; // world, metres

void main() {
    gl_Position = push.clip_from_world * vec4(position, 1.0);
}
