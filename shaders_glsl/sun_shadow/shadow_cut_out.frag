#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

layout(location = 0) in vec2 surface_uv;

layout(set = 0, binding = 0) uniform sampler2D diffuse_map;

#include "shadow_cut_out_push.glsl"

void main() {
    // A point of the finest level: coarser ones have the mean, which is below the cut-off everywhere where leaves cover less than half, so that
    // crowns in coarse maps would have no shadow.
    if (textureLod(diffuse_map, surface_uv, 0.0).a < push.cutoff) discard;
}
