#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scene_light.glsl"
#include "surface_light.glsl"
#include "emitters.glsl"
#include "filtered.glsl"
#include "cells.glsl"
#include "cell_table.glsl"

// Adds paths to the cells: each from one of a cell's points over diffuse surfaces, with the light of sun and sky at each, ending in the cells.
// Reads the published cells and writes the sums, so the outcome does not depend on the order of the invocations.

layout(local_size_x = 64) in;

TABLE;
PLACES;
SUMS;

layout(set = 0, binding = 7) uniform samplerCube sky_radiance; // L of sky and ground, kcd/m^2, without the disc

layout(push_constant, scalar) uniform Push {
    uint segments;     // of a path at most; 0: no bounces
    uint ends_in_cell; // whether a path takes the bounces of the cell at its end: all bounces instead of as many as segments
    uint paths;        // in all: few cells get several each; of many each gets one in turn
    uint first;        // of the live cells whose turn it is
    uint turns;        // number of them
    uint young;        // paths of a young cell at least
    uint seen;         // paths besides, for the cells in view
    float most;        // paths that the old means count for: few after a change of the light
    vec3 sky_change;   // factor on the old means of the sky
    vec3 bounce_change; // factor on the old means of the bounces
} push;

// Paths after which a cell is not updated any more.
const uint ENOUGH = 4096u;

/// Irradiance of the bounces along a path that starts with a ray from a point to a surface, klx; what that surface emits is not in it.
vec3 path_light(Surface surface, inout uint state) {
    vec3 light = vec3(0.0), throughput = vec3(1.0);
    for (uint segment = 1u; segment <= push.segments; ++segment) {
        throughput *= surface.albedo;
        vec3 sun = sun_irradiance_at(surface.position, surface.normal, vec2(rnd(state), rnd(state)));
        Cached here = cached(surface.position, surface.normal);
        // What is published is still of the old light.
        here.sky *= push.sky_change;
        here.bounce *= push.bounce_change;
        light += throughput * (sun + here.sky);
        bool is_last = segment == push.segments;
        // Russian roulette between the cell and another segment: bounces between dark surfaces converge at once.
        if (push.ends_in_cell != 0u && here.is_found) {
            float reflected = max(surface.albedo.r, max(surface.albedo.g, surface.albedo.b));
            if (is_last || rnd(state) >= reflected * reflected) return light + throughput * here.bounce;
        }
        if (is_last) break;
        if (EMITS) light += throughput * emission_of_point(surface.position, surface.normal, surface.normal, vec2(rnd(state), rnd(state)));
        vec3 toward = cosine_direction(surface.normal, vec2(rnd(state), rnd(state)));
        Hit hit = closest(surface.position, toward, FAR);
        if (hit.distance == FAR) {
            // The sky's share is in the cell, if there is one.
            if (!here.is_found) light += throughput * PI * filtered(sky_radiance, toward, 0.0).rgb;
            break;
        }
        Surface next = surface_of(hit, surface.position, toward);
        light += throughput * emission_of_ray(next, dot(surface.normal, toward), toward, hit.distance);
        surface = next;
    }
    return light;
}

/// Adds a path to the means of a cell.
void add_path(inout Sum sum, uint slot, uint print) {
    uint number = uint(sum.samples);
    uint state = tea(print, tea(scene.seed, number ^ scene.frame << 16));
    Point point = points[slot * POINTS + state % POINTS];
    vec3 n = normal_unpack(point.normal);
    vec3 toward = cosine_direction(n, scrambled_sobol(number, tea(print, scene.seed)));
    Hit hit = closest(point.position, toward, FAR);
    vec3 sky = vec3(0.0), bounce = vec3(0.0);
    if (hit.distance == FAR) sky = PI * filtered(sky_radiance, toward, 0.0).rgb;
    else if (push.segments > 0u) {
        Surface surface = surface_of(hit, point.position, toward);
        bounce = emission_of_ray(surface, dot(n, toward), toward, hit.distance) + path_light(surface, state);
    }
    if (EMITS && push.segments > 0u) bounce += emission_of_point(point.position, n, n, scrambled_sobol(number, tea(scene.seed, print)));
    // Later paths end in better cells: the weights of their light grow with the cube of their number.
    float k = sum.samples + 1.0;
    float late = 4.0 * k / ((k + 1.0) * (k + 1.0));
    sum.sky = mix(sum.sky, sky, 1.0 / k);
    sum.sky_gradient = mix(sum.sky_gradient, gradient_of(luminance(sky), toward, n), 1.0 / k);
    sum.bounce = mix(sum.bounce, bounce, late);
    sum.bounce_gradient = mix(sum.bounce_gradient, gradient_of(luminance(bounce), toward, n), late);
    sum.samples = k;
}

/// Paths of a cell in this round. The light of cells in view is seen itself, that of others as part of a mean over many.
uint paths_of(float samples, bool has_turn, bool is_in_view) {
    if (samples >= float(ENOUGH)) return 0u;
    // Young cells do not wait for their turn.
    bool is_young = samples < YOUNG;
    uint paths = 0u;
    if (is_young || has_turn) paths = clamp(push.paths / live_count, is_young ? push.young : 1u, MOST_PATHS);
    return is_in_view ? paths + min(push.seen / seen_count, MOST_SEEN_PATHS) : paths;
}

/// Adds the paths of live cell number `index`.
void update(uint index) {
    uint slot = live[index];
    Sum sum = sums[slot];
    bool has_turn = is_due(index, live_count, push.first, push.turns);
    bool is_in_view = is_seen(stamps[slot], scene.frame);
    if (!has_turn && !is_in_view && sum.samples >= YOUNG) return;
    uint print = prints[slot];
    if ((print & ANCHORED) == 0u) return;
    sum.samples = min(sum.samples, push.most);
    sum.sky *= push.sky_change;
    sum.bounce *= push.bounce_change;
    sum.sky_gradient *= luminance(push.sky_change);
    sum.bounce_gradient *= luminance(push.bounce_change);
    uint paths = paths_of(sum.samples, has_turn, is_in_view);
    for (uint i = 0u; i < paths; ++i) add_path(sum, slot, print & ~FLAGS);
    sums[slot] = sum;
}

void main() {
    for (uint index = gl_GlobalInvocationID.x; index < live_count; index += gl_NumWorkGroups.x * gl_WorkGroupSize.x) update(index);
}
