#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scene_light.glsl"
#include "surface_hit.glsl"
#include "cell_grid.glsl"
#include "cell_table.glsl"
#include "view.glsl"

// Creates cells where light paths from the eye meet surfaces. Each invocation is a path; each point of it enters the contest for a
// place in its cell, which the smallest hash wins: the outcome does not depend on the order of the invocations.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, scalar) uniform View { VIEW_BLOCK } view;

PRINTS;
LIVE;
PLACES;
CONTESTS;
CANDIDATES;

layout(push_constant, scalar) uniform Push {
    uint paths;
} push;

/// The slot of a cell, created if there is none; NONE if its bucket is full.
uint claim_slot(Key key) {
    for (uint i = 0u; i < BUCKET; ++i) {
        if ((prints[key.bucket + i] & ~FLAGS) == key.print) return key.bucket + i;
    }
    for (uint i = 0u; i < BUCKET; ++i) {
        uint slot = key.bucket + i;
        uint found = atomicCompSwap(prints[slot], 0u, key.print);
        if (found == 0u) {
            live[atomicAdd(live_count, 1u)] = slot;
            return slot;
        }
        if ((found & ~FLAGS) == key.print) return slot;
    }
    return NONE;
}

/// The slot of the cell of a point, created if there is none; NONE if the table is full there. `is_new`: it has no anchor yet.
uint claim(vec3 p, vec3 n, int level, out bool is_new) {
    float edge = cell_edge(level);
    ivec3 at = ivec3(floor(in_grid(p, n, edge)));
    uint side = dominant(n);
    for (uint sibling = 0u; sibling < SIBLINGS; ++sibling) {
        uint slot = claim_slot(cell_key(at, side, level, sibling));
        if (slot == NONE) return NONE;
        is_new = (prints[slot] & ANCHORED) == 0u;
        if (is_new || is_seen(points[slot * POINTS].position, p, n, edge)) return slot;
        atomicOr(prints[slot], MIXED);
    }
    return NONE;
}

/// A point of a path enters the contest of its cell.
void enter(uint index, vec3 p, vec3 n, uint hash) {
    candidates[index].slot = NONE;
    // Some points are for larger cells, which stand in where small ones are missing.
    int level = cell_level(distance(p, scene.eye)) + ((hash & 0x700u) == 0u ? 2 : 0);
    bool is_new;
    uint slot = claim(p, n, level, is_new);
    if (slot == NONE) return;
    uint place = slot * POINTS + (is_new ? 0u : 1u + (hash >> 16) % (POINTS - 1u));
    atomicMin(contests[place], hash);
    candidates[index] = Candidate(slot, place, hash, Point(p, normal_pack(n)));
}

void main() {
    uint path = gl_GlobalInvocationID.x;
    if (path >= push.paths) return;
    uint state = tea(path, tea(scene.seed, scene.frame));
    vec2 uv = fract(vec2(0.5) + float(path) * vec2(0.7548776662, 0.5698402910) + vec2(rnd(state), rnd(state)));
    vec3 origin = view.eye;
    vec3 toward = normalize(view.world_from_view * view_ray(uv, view.ray_scale, view.ray_offset));
    for (uint i = 0u; i < PATH_POINTS; ++i) candidates[path * PATH_POINTS + i].slot = NONE;
    for (uint i = 0u; i < PATH_POINTS; ++i) {
        Hit hit = closest(origin, toward, FAR);
        if (hit.distance == FAR) return;
        Surface surface = surface_of(hit, origin, toward);
        state = tea(state, i);
        enter(path * PATH_POINTS + i, surface.position, surface.normal, state);
        origin = surface.position;
        toward = cosine_direction(surface.normal, vec2(rnd(state), rnd(state)));
    }
}
