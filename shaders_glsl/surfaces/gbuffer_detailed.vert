#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

layout(location = 0) in vec3 position; // world, metres
layout(location = 1) in vec4 normal;   // world; w: thickness behind the surface, metres
layout(location = 2) in vec2 texcoord;
layout(location = 3) in vec4 colour;   // linear RGBA
layout(location = 4) in vec4 tangent;  // world; w: sign of the bitangent

layout(location = 0) out vec3 from_eye;
layout(location = 1) out vec3 shading_normal;
layout(location = 2) out vec2 surface_uv;
layout(location = 3) out vec4 surface_colour;
layout(location = 4) out vec4 surface_tangent;
layout(location = 5) flat out float thickness;

#include "gbuffer_push.glsl"

void main() {
    gl_Position = push.clip_from_world * vec4(position, 1.0);
    // Relative to the eye, so that derivatives keep their digits far from the origin.
    from_eye = position - push.eye;
    shading_normal = normal.xyz;
    thickness = normal.w;
    surface_uv = texcoord;
    surface_colour = colour;
    surface_tangent = tangent;
}
