#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "glass.glsl"
#include "shadow_glass_push.glsl"

// What a pane of glass lets through of the light, and its depth: the products of all panes are taken, and the depth nearest the light.

layout(location = 0) in vec3 shading_normal;

layout(location = 0) out vec4 glass;

void main() {
    float cosine = dot(normalize(shading_normal), push.toward);
    glass = vec4(pane_transmittance(push.internal, glass_surface(cosine)), gl_FragCoord.z);
}
