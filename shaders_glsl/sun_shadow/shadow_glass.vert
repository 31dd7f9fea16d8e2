#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shadow_glass_push.glsl"

layout(location = 0) in vec3 position; // world, metres
layout(location = 1) in vec3 normal;   // world

layout(location = 0) out vec3 shading_normal;

void main() {
    gl_Position = push.shadow_from_world * vec4(position, 1.0);
    shading_normal = normal;
}
