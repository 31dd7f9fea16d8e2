#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "glass.glsl"
#include "pane.glsl"

// What a pane of glass lets through of the picture behind it; the products of all panes are taken.

layout(location = 0) in vec3 from_eye;
layout(location = 1) in vec3 shading_normal;

layout(location = 0) out vec4 through;

void main() {
    float cosine = dot(normalize(shading_normal), normalize(from_eye));
    through = vec4(pane_transmittance(push.internal, glass_surface(cosine)), 1.0);
}
