#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

layout(location = 0) in vec3 position; // world, metres
layout(location = 1) in vec2 texcoord;

layout(location = 0) out vec2 surface_uv;

#include "shadow_cut_out_push.glsl"

void main() {
    gl_Position = push.shadow_from_world * vec4(position, 1.0);
    surface_uv = texcoord;
}
