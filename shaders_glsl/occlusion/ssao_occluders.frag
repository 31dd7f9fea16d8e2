#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "materials.glsl"
#include "occlusion.glsl"

// Packs every DOWNSCALE-th pixel of the G-buffer into one word, which ssao.frag looks up many times.

layout(location = 0) out uint occluder;

layout(constant_id = 0) const int DOWNSCALE = 1;
layout(constant_id = 1) const float CHORDS = 1.0; // factor on the thickness of bodies

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform usampler2D normal_material;

layout(push_constant, scalar) uniform Push {
    float near; // metres
} push;

void main() {
    vec2 pixel = floor(gl_FragCoord.xy) * float(DOWNSCALE);
    float d = texel_at(depth, pixel).r;
    float thickness = material_thickness(texel_at(normal_material, pixel).y) * CHORDS;
    occluder = occluder_pack(d > 0.0 ? push.near / d : NOWHERE, thickness);
}
