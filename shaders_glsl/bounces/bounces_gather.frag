#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scene_light.glsl"
#include "surface_hit.glsl"
#include "cells.glsl"
#include "face.glsl"

// One ray from each pixel: the irradiance of the light that the surface it meets reflects. Rays that meet none see the sky, which the
// dome adds.

layout(location = 0) out vec4 bounced; // rgb: irradiance, klx

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform usampler2D normal_material;
layout(set = 0, binding = 2, scalar) uniform View { VIEW_BLOCK } view;

layout(push_constant, scalar) uniform Push {
    uint index;   // of this frame in the average
    ivec2 origin; // of this picture in the whole one, pixels
} push;

void main() {
    bounced = vec4(0.0);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 size = vec2(textureSize(depth, 0));
    vec2 uv = gl_FragCoord.xy / size;
    float d = texelFetch(depth, pixel, 0).r;
    vec3 ray = view_ray(uv, view.ray_scale, view.ray_offset);
    vec3 world = view.eye + view.world_from_view * (ray * (view.near / d));
    uvec3 own = texelFetch(normal_material, pixel, 0).xyz;
    vec3 n = normal_unpack(own.x);
    vec3 face = view.world_from_view * face_normal(own.z, ray.xy, 0.5 * size / view.ray_scale);
    ivec2 whole = pixel + push.origin;
    uint seed = tea(uint(whole.x) | uint(whole.y) << 16, scene.seed);
    vec3 toward = cosine_direction(n, scrambled_sobol(push.index, seed));
    // Below the face: inside of the body.
    if (is_turned_away(face, n, toward)) return;
    vec3 origin = lifted(world, dot(face, n) > SAME_FACE ? face : n);
    Hit hit = closest(origin, toward, FAR);
    if (hit.distance == FAR) return;
    Surface surface = surface_of(hit, origin, toward);
    uint state = tea(seed, push.index);
    vec3 sun = sun_irradiance_at(surface.position, surface.normal, vec2(rnd(state), rnd(state)));
    Cached here = cached(surface.position, surface.normal);
    bounced.rgb = surface.albedo * (sun + here.sky + here.bounce) + PI * surface.emission;
}
