#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scene_light.glsl"
#include "cells.glsl"
#include "half_size.glsl"
#include "view.glsl"

// Irradiance of the sky and of the bounces at a pixel of each square of two by two, interpolated between the cells.

layout(location = 0) out uvec4 ambient; // see half_size.glsl

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform usampler2D normal_material;
layout(set = 0, binding = 2, scalar) uniform View { VIEW_BLOCK } view;

void main() {
    vec2 pixel = 2.0 * floor(gl_FragCoord.xy);
    float d = texel_at(depth, pixel).r;
    ambient = uvec4(0u);
    if (d == 0.0) return;
    vec3 ray = view_ray((pixel + 0.5) / vec2(textureSize(depth, 0)), view.ray_scale, view.ray_offset);
    float distance = view.near / d;
    uint normal = texel_at(normal_material, pixel).x;
    vec3 world = view.eye + view.world_from_view * (ray * distance);
    Cached light = interpolated(world, normal_unpack(normal));
    // Where there is no cell yet, the texels beside it stand in.
    if (!light.is_found) return;
    ambient = half_size_pack(Ambient(light.sky, light.bounce), distance, normal);
}
