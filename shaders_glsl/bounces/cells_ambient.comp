#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scene_light.glsl"
#include "bvh.glsl"
#include "cells.glsl"
#include "half_size.glsl"
#include "view.glsl"

// Irradiance of the sky and of the bounces at a pixel of each square of two by two, interpolated between the cells.

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform usampler2D normal_material;
layout(set = 0, binding = 2, scalar) uniform View { VIEW_BLOCK } view;
layout(set = 0, binding = 3, rgba32ui) uniform writeonly uimage2DArray ambient; // see half_size.glsl

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(ambient).xy))) return;
    vec2 pixel = vec2(2 * texel);
    float d = texel_at(depth, pixel).r;
    uvec4 result = uvec4(0u);
    if (d > 0.0) {
        vec3 ray = view_ray((pixel + 0.5) / vec2(textureSize(depth, 0)), view.ray_scale, view.ray_offset);
        float distance = view.near / d;
        uint normal = texel_at(normal_material, pixel).x;
        vec3 world = view.eye + view.world_from_view * (ray * distance);
        Cached light = interpolated(world, normal_unpack(normal));
        result = half_size_pack(Ambient(light.sky, light.bounce), distance, normal);
    }
    imageStore(ambient, ivec3(texel, 0), result);
}
