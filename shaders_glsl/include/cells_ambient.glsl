#include "scene_light.glsl"
#include "cells.glsl"
#include "half_size.glsl"
#include "view.glsl"

// Irradiance of the sky and of the bounces at a pixel of each square of two by two, interpolated between the cells.

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform usampler2D normal_material;
layout(set = 0, binding = 2, scalar) uniform View { VIEW_BLOCK } view;

/// A texel, see half_size.glsl; `at`: its centre.
uvec4 ambient_at(vec2 at) {
    vec2 pixel = 2.0 * floor(at);
    float d = texel_at(depth, pixel).r;
    if (d == 0.0) return uvec4(0u);
    vec3 ray = view_ray((pixel + 0.5) / vec2(textureSize(depth, 0)), view.ray_scale, view.ray_offset);
    float distance = view.near / d;
    uint normal = texel_at(normal_material, pixel).x;
    vec3 world = view.eye + view.world_from_view * (ray * distance);
    Cached light = interpolated(world, normal_unpack(normal));
    // Where there is no cell yet, the texels beside it stand in.
    if (!light.is_found) return uvec4(0u);
    return half_size_pack(Ambient(light.sky, light.bounce), distance, normal);
}
