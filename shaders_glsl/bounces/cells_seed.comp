#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scene_light.glsl"
#include "surface_light.glsl"
#include "cell_grid.glsl"
#include "cell_table.glsl"
#include "view.glsl"

// Creates cells where light paths from the eye meet surfaces. Each invocation is a path; each point of it enters the contest for a
// place in its cell, which the smallest hash wins: the outcome does not depend on the order of the invocations.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, scalar) uniform View { VIEW_BLOCK } view;

TABLE;
PLACES;
CONTESTED;

layout(push_constant, scalar) uniform Push {
    uint paths;
} push;

// Rounds after which a cell that no path has met gives way to a new one, if its bucket is full.
const uint KEPT_ROUNDS = 256u;

/// Takes the slot that paths have not met for longest from its cell; NONE if all are in use.
uint take_over(Key key) {
    uint oldest = key.bucket;
    for (uint i = 1u; i < BUCKET; ++i) if (stamps[key.bucket + i] < stamps[oldest]) oldest = key.bucket + i;
    if (round_of(stamps[oldest]) + KEPT_ROUNDS > scene.frame) return NONE;
    uint before = prints[oldest];
    if (atomicCompSwap(prints[oldest], before, key.print) != before) return NONE;
    for (uint i = 0u; i < CONTESTS; ++i) contests[oldest * CONTESTS + i] = 0xffffffffu;
    return oldest;
}

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
    return take_over(key);
}

/// Notes that a path meets a cell. Each cell in view is counted once.
void meet(uint slot, bool is_seen) {
    uint now = stamp(scene.frame, is_seen);
    if (atomicMax(stamps[slot], now) < now && is_seen) atomicAdd(seen_count, 1u);
}

/// The slot of the cell of a point, created if there is none, and the contest for it; NONE if the table is full there.
uint claim(vec3 p, vec3 n, int level, bool is_seen, out uint contest) {
    float edge = cell_edge(level);
    ivec3 at = ivec3(floor(in_grid(p, n, edge)));
    uint side = dominant(n);
    for (uint sibling = 0u; sibling < SIBLINGS; ++sibling) {
        uint slot = claim_slot(cell_key(at, side, level, sibling));
        if (slot == NONE) return NONE;
        meet(slot, is_seen);
        uint print = prints[slot];
        if ((print & DIVIDED) != 0u && !is_on_side(walls[slot], p)) continue;
        contest = (print & (ANCHORED | DIVIDED)) == ANCHORED ? WALL : 0u;
        return slot;
    }
    return NONE;
}

/// Whether something stands between a point and the anchor of its cell.
bool is_divided(vec3 p, vec3 n, vec3 anchor, float edge) {
    vec3 from = p + n * (SIGHT * edge), way = anchor - p;
    float far = length(way);
    return far > 1e-3 * edge && is_parted(from, way / far, far);
}

/// A point of a path enters a contest of its cell.
void enter(uint index, vec3 p, vec3 n, bool is_seen, uint hash) {
    int level = candidate_level(p, hash);
    uint contest;
    uint slot = claim(p, n, level, is_seen, contest);
    if (slot == NONE) return;
    // What does not see the anchor asks for a wall.
    if (contest == WALL && !is_divided(p, n, points[slot * POINTS].position, cell_edge(level))) contest = 0u;
    uint place = slot * CONTESTS + contest;
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
        Hit hit = traced(origin, toward, FAR, false, PANES_ARE_OPEN);
        if (hit.distance == FAR) return;
        Surface surface = surface_of(hit, origin, toward);
        state = tea(state, i);
        enter(path * PATH_POINTS + i, surface.position, surface.normal, i == 0u, state);
        origin = surface.position;
        toward = cosine_direction(surface.normal, vec2(rnd(state), rnd(state)));
    }
}
