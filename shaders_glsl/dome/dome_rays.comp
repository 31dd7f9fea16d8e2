#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "bvh.glsl"
#include "colour.glsl"
#include "constants.glsl"
#include "dome.glsl"
#include "octahedral.glsl"

// The light of the dome's directions by rays instead of maps: a ray from each pixel in each of them. All pixels have the same
// directions, so rays beside each other visit the same nodes.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const int DIRECTIONS = 4;
// Maps hold what rays do not know: the holes of cut-outs, and panes of glass.
layout(constant_id = 1) const bool MAPS = false;

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform usampler2D normal_material;
layout(set = 0, binding = 2, scalar) uniform View { VIEW_BLOCK } view;
layout(set = 0, binding = 3, rgba32f) uniform writeonly image2DArray sky_light; // see dome_light.glsl

layout(push_constant, scalar) uniform Push {
    vec3 ground; // radiance below the horizon, kcd/m^2
} push;

bool is_reached(int k, vec3 world, vec3 n, vec3 face) {
    vec3 toward = dome.toward[k].xyz;
    if (is_turned_away(face, n, toward)) return false;
    if (MAPS && !is_lit_in_map(k, world, face)) return false;
    float error = corner_error(view.ray_scale, vec2(textureSize(depth, 0)));
    return traced(lifted_toward(world, face, toward, view.eye, error), toward, FAR, true, OPAQUE_ONLY).distance == FAR;
}

#include "dome_light.glsl"

/// The pixel of an invocation: those of a software device's vectors, eight in a row, are a block of 4 by 2.
ivec2 own_pixel() {
    ivec2 within = ivec2(gl_LocalInvocationID.xy);
    ivec2 in_block = ivec2(within.x & 3, within.x >> 2);
    ivec2 block = ivec2(4 * (within.y & 1), within.y & 6);
    return ivec2(8u * gl_WorkGroupID.xy) + block + in_block;
}

void main() {
    ivec2 pixel = own_pixel();
    ivec2 size = textureSize(depth, 0);
    if (any(greaterThanEqual(pixel, size))) return;
    float d = texelFetch(depth, pixel, 0).r;
    vec4 light = vec4(0.0);
    if (d > 0.0) {
        vec3 ray = view_ray((vec2(pixel) + 0.5) / vec2(size), view.ray_scale, view.ray_offset);
        vec3 world = view.eye + view.world_from_view * (ray * (view.near / d));
        uvec3 own = texelFetch(normal_material, pixel, 0).xyz;
        vec3 face = view.world_from_view * face_normal(own.z, ray.xy, 0.5 * vec2(size) / view.ray_scale);
        light = light_of_directions(world, normal_unpack(own.x), face, push.ground);
    }
    imageStore(sky_light, ivec3(pixel, 0), light);
}
