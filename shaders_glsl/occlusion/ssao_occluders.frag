#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "materials.glsl"
#include "occluder.glsl"

// Every DOWNSCALE-th pixel of the G-buffer as the one word that ssao.frag fetches many times.

layout(location = 0) out uint occluder;

// Thickness in mean chords of the body: what stands behind it hides too. Measured: the least bias against path-traced views.
const float CHORDS = 1.9;

layout(constant_id = 0) const int DOWNSCALE = 2;

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform usampler2D normal_material;

layout(push_constant, scalar) uniform Push {
    float near; // metres
} push;

void main() {
    // Nearest lookups: a software device checks fetches against the edges.
    vec2 uv = (floor(gl_FragCoord.xy) * float(DOWNSCALE) + 0.5) / vec2(textureSize(depth, 0));
    float d = textureLod(depth, uv, 0.0).r;
    float thickness = material_thickness(textureLod(normal_material, uv, 0.0).y) * CHORDS;
    occluder = occluder_pack(d > 0.0 ? push.near / d : NOWHERE, thickness);
}
