#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// For surfaces without maps whose stored normals agree with their winding. A software device pays for every component that
// it carries from vertices to pixels: these are four instead of nine.

layout(location = 0) in vec3 position; // world, metres
layout(location = 1) in vec4 normal;   // world; w: thickness behind the surface, metres

layout(location = 0) out vec4 surface; // the same

#include "gbuffer_push.glsl"

void main() {
    gl_Position = push.clip_from_world * vec4(position, 1.0);
    surface = normal;
}
