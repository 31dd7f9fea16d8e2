#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "cell_flags.glsl"
#include "cell_table.glsl"

// The winners of the contests become points of their cells. An invocation is a candidate.

layout(local_size_x = 64) in;

PRINTS;
PLACES;
CONTESTS;
CANDIDATES;

layout(push_constant, scalar) uniform Push {
    uint candidates;
} push;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.candidates) return;
    Candidate candidate = candidates[index];
    if (candidate.slot == NONE || contests[candidate.place] != candidate.hash) return;
    points[candidate.place] = candidate.point;
    uint anchor = candidate.slot * POINTS;
    if (candidate.place != anchor) return;
    // A new cell: all of its points are the anchor until others come.
    for (uint i = 1u; i < POINTS; ++i) points[anchor + i] = candidate.point;
    atomicOr(prints[candidate.slot], ANCHORED);
}
