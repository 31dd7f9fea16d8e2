#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scene_light.glsl"
#include "bvh.glsl"
#include "cell_grid.glsl"
#include "cell_table.glsl"

// The winners of the contests become points of their cells, or divide them. An invocation is a candidate.

layout(local_size_x = 64) in;

TABLE;
PLACES;
CONTESTED;
SUMS;

layout(push_constant, scalar) uniform Push {
    uint candidates;
} push;

/// A bit for each neighbouring cell that something hides from the anchor.
uint hidden_neighbours(Point anchor, float edge) {
    vec3 n = normal_unpack(anchor.normal);
    uint axis = dominant(n) % 3u;
    vec3 place = turned(in_grid(anchor.position, n, edge), axis), slope = turned(n, axis);
    vec3 from = anchor.position + n * (SIGHT * edge);
    uint hidden = 0u;
    for (int i = 0; i < 8; ++i) {
        // To the middle of the neighbour, along the tangent plane.
        vec2 way = floor(place.xy) + vec2(NEIGHBOURS[i]) + 0.5 - place.xy;
        vec3 offset = edge * turned_back(vec3(way, -dot(slope.xy, way) / slope.z), axis);
        float far = length(offset);
        if (is_parted(from, offset / far, far)) hidden |= 1u << i;
    }
    return hidden;
}

/// The plane of what stands between a point and the anchor of its cell; 0 if there is nothing.
uvec2 wall_between(Point point, vec3 anchor, float edge) {
    vec3 n = normal_unpack(point.normal);
    vec3 from = point.position + n * (SIGHT * edge), way = anchor - point.position;
    float far = length(way);
    Hit hit = traced(from, way / far, far, false, PANES_BLOCK);
    if (hit.distance == FAR) return uvec2(0u);
    vec3 edge1 = uintBitsToFloat(triangle_texel(hit.triangle, 1u).xyz);
    vec3 edge2 = uintBitsToFloat(triangle_texel(hit.triangle, 2u).xyz);
    vec3 normal = normalize(cross(edge1, edge2));
    if (dot(normal, way) < 0.0) normal = -normal;
    return wall_pack(normal, from + way / far * hit.distance);
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.candidates) return;
    Candidate candidate = candidates[index];
    if (candidate.slot == NONE || contests[candidate.place] != candidate.hash) return;
    uint contest = candidate.place - candidate.slot * CONTESTS, first = candidate.slot * POINTS;
    int level = candidate_level(candidate.point.position, candidate.hash);
    float edge = cell_edge(level);
    if (contest == WALL) {
        walls[candidate.slot] = wall_between(candidate.point, points[first].position, edge);
        atomicOr(prints[candidate.slot], DIVIDED);
        return;
    }
    points[first + 1u] = candidate.point;
    if ((prints[candidate.slot] & ANCHORED) != 0u) return;
    // A new cell: its second point is the anchor too until another one comes.
    points[first] = candidate.point;
    uint hidden = hidden_pack(hidden_neighbours(candidate.point, edge), level);
    sums[candidate.slot] = Sum(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0, hidden);
    atomicOr(prints[candidate.slot], ANCHORED);
}
