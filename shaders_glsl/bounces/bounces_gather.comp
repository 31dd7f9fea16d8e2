#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scene_light.glsl"
#include "surface_light.glsl"
#include "emitters.glsl"
#include "cells.glsl"
#include "face.glsl"
#include "half_size.glsl"

// One ray from a pixel of each square of two by two: the irradiance of the light that the surface it meets emits and reflects. Rays
// that meet none see the sky, which the dome adds. A second ray goes to a point that emits light, if there is any.

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform usampler2D normal_material;
layout(set = 0, binding = 2, scalar) uniform View { VIEW_BLOCK } view;
layout(set = 0, binding = 3, rgba32ui) uniform writeonly uimage2DArray bounced; // see half_size.glsl

layout(push_constant, scalar) uniform Push {
    uint index;   // of this frame in the average
    ivec2 origin; // of this picture in the whole one, pixels
    ivec2 chosen; // pixel of each square
    float share;  // of the rays in the light, 0..1; the rest is from the cells around the pixel
} push;

/// Irradiance that the rays from a pixel bring, klx.
vec3 gathered(ivec2 pixel, vec3 ray, vec3 world, uvec3 own, vec3 n) {
    vec2 size = vec2(textureSize(depth, 0));
    vec3 face = view.world_from_view * face_normal(own.z, ray.xy, 0.5 * size / view.ray_scale);
    ivec2 whole = pixel + push.origin;
    uint seed = tea(uint(whole.x) | uint(whole.y) << 16, scene.seed);
    // A pixel gets every fourth set of rays. Every fourth point of a Sobol sequence is in one quarter of the first dimension: a ring of
    // the hemisphere. So each takes its points one after the other.
    uint number = push.index / 4u;
    vec3 toward = cosine_direction(n, scrambled_sobol(number, seed));
    vec3 side = dot(face, n) > SAME_FACE ? face : n;
    vec3 origin = lifted_from(world, side, view.eye, corner_error(view.ray_scale, size));
    vec3 emitted = vec3(0.0);
    if (EMITS) emitted = emission_of_point(origin, n, side, scrambled_sobol(number, tea(seed, 2u)));
    // Below the face: inside of the body.
    if (is_turned_away(face, n, toward)) return emitted;
    Hit hit = closest(origin, toward, FAR);
    if (hit.distance == FAR) return emitted;
    Surface surface = surface_of(hit, origin, toward);
    uint state = tea(seed, push.index);
    vec3 sun = sun_irradiance_at(surface.position, surface.normal, vec2(rnd(state), rnd(state)));
    Cached here = cached(surface.position, surface.normal);
    emitted += emission_of_ray(surface, dot(n, toward), toward, hit.distance);
    return surface.albedo * (sun + here.sky + here.bounce) + emitted;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = textureSize(depth, 0);
    if (any(greaterThanEqual(texel, imageSize(bounced).xy))) return;
    ivec2 pixel = min(2 * texel + push.chosen, size - 1);
    float d = texelFetch(depth, pixel, 0).r;
    uvec4 result = uvec4(0u);
    if (d > 0.0) {
        vec3 ray = view_ray((vec2(pixel) + 0.5) / vec2(size), view.ray_scale, view.ray_offset);
        uvec3 own = texelFetch(normal_material, pixel, 0).xyz;
        float distance = view.near / d;
        vec3 world = view.eye + view.world_from_view * (ray * distance);
        vec3 n = normal_unpack(own.x);
        vec3 bounce = gathered(pixel, ray, world, own, n);
        Cached here = interpolated(world, n);
        if (here.is_found) bounce = mix(here.bounce, bounce, push.share);
        result = half_size_pack(Ambient(vec3(0.0), bounce), distance, own.x);
    }
    imageStore(bounced, ivec3(texel, 0), result);
}
