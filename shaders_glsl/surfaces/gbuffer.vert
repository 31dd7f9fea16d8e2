#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// Variant: DETAILED
#include "gbuffer.glsl"

layout(location = 0) in vec3 position; // world, metres
layout(location = 1) in vec3 normal;   // world
layout(location = 2) in vec2 texcoord;

layout(location = 0) out vec3 from_eye;
layout(location = 1) out vec3 shading_normal;
layout(location = 2) out vec2 surface_uv;

#ifdef DETAILED
layout(location = 3) in vec4 colour;  // linear RGBA
layout(location = 4) in vec4 tangent; // world; w: sign of the bitangent

layout(location = 3) out vec4 surface_colour;
layout(location = 4) out vec4 surface_tangent;
#endif

void main() {
    gl_Position = camera.clip_from_world * vec4(position, 1.0);
    // Relative to the eye, so that derivatives stay precise far from the origin.
    from_eye = position - camera.eye;
    shading_normal = normal;
    surface_uv = texcoord;
#ifdef DETAILED
    surface_colour = colour;
    surface_tangent = tangent;
#endif
}
