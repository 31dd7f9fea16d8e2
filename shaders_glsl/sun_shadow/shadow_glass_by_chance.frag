#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "colour.glsl"
#include "glass.glsl"
#include "random.glsl"
#include "shadow_glass_push.glsl"

// A pane of glass in one of many shadow maps, whose light is averaged: a texel is there in proportion to what the pane stops.

layout(location = 0) in vec3 shading_normal;

void main() {
    float cosine = dot(normalize(shading_normal), push.toward);
    float through = luminance(pane_transmittance(push.internal, glass_surface(cosine)));
    uvec2 texel = uvec2(gl_FragCoord.xy);
    uint state = tea(texel.x | texel.y << 16, floatBitsToUint(push.toward.x) ^ floatBitsToUint(push.toward.y) << 1);
    if (rnd(state) < through) discard;
}
