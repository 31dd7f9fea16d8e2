#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "pane.glsl"

layout(location = 0) in vec3 position; // world, metres
layout(location = 1) in vec3 normal;   // world

layout(location = 0) out vec3 from_eye;
layout(location = 1) out vec3 shading_normal;

void main() {
    gl_Position = camera.clip_from_world * vec4(position, 1.0);
    from_eye = position - camera.eye;
    shading_normal = normal;
}
