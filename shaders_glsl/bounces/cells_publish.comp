#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scene_light.glsl"
#include "cell_grid.glsl"
#include "cell_table.glsl"
#include "shared_exponent.glsl"

// Copies the live cells to the images that lookups read, and opens the contests for their points again. Cells with few paths are
// noisy: their light is smoothed over the neighbours that they see.

layout(local_size_x = 64) in;

PRINTS;
LIVE;
PLACES;
CONTESTED;
WALLS;
SUMS;

layout(set = 0, binding = 8, rgba32ui) uniform writeonly uimage2DArray cells;
layout(set = 0, binding = 9, rgba32f) uniform writeonly image2DArray cell_walls;

// Paths after which the smoothing fades out.
const float SMOOTHED = 512.0;

/// The slot of the cell of a point at a place of the grid, or NONE.
uint slot_at(ivec3 at, uint side, int level, vec3 p) {
    for (uint sibling = 0u; sibling < SIBLINGS; ++sibling) {
        Key key = cell_key(at, side, level, sibling);
        uint found = NONE;
        for (uint i = 0u; i < BUCKET && found == NONE; ++i) {
            if ((prints[key.bucket + i] & ~FLAGS) == key.print) found = key.bucket + i;
        }
        if (found == NONE) return NONE;
        if ((prints[found] & DIVIDED) == 0u || is_on_side(walls[found], p)) return found;
    }
    return NONE;
}

/// The light of a cell, smoothed over its neighbours along the surface.
Sum smoothed(uint slot) {
    Sum own = sums[slot];
    Point anchor = points[slot * POINTS];
    int level = int(own.hidden >> 8);
    vec3 n = normal_unpack(anchor.normal);
    uint side = dominant(n), axis = side % 3u;
    vec3 place = turned(in_grid(anchor.position, n, cell_edge(level)), axis), slope = turned(n, axis);
    float fade = own.samples / SMOOTHED;
    float spread = 1.0 / (1.0 + fade * fade);
    float sum = own.samples;
    vec3 sky = own.sky * sum, bounce = own.bounce * sum;
    for (int i = 0; i < 8; ++i) {
        vec2 cell = floor(place.xy) + vec2(NEIGHBOURS[i]);
        float height = place.z - dot(slope.xy, cell + 0.5 - place.xy) / slope.z;
        uint neighbour = slot_at(ivec3(turned_back(vec3(cell, floor(height)), axis)), side, level, anchor.position);
        if (neighbour == NONE || (own.hidden & 1u << i) != 0u) continue;
        Sum other = sums[neighbour];
        // A tent: half beside, a quarter at the corners.
        float weight = spread * other.samples * ((i & 1) == 0 ? 0.5 : 0.25);
        sky += weight * other.sky;
        bounce += weight * other.bounce;
        sum += weight;
    }
    float scale = sum > 0.0 ? 1.0 / sum : 0.0;
    return Sum(sky * scale, bounce * scale, own.samples, own.hidden);
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= live_count) return;
    uint slot = live[index];
    ivec3 texel = ivec3(slot_texel(slot), 0);
    Sum sum = smoothed(slot);
    uint word = uint(sum.samples) | (sum.hidden & 0xffu) << SAMPLE_BITS;
    imageStore(cells, texel, uvec4(prints[slot], shared_exponent_pack(sum.sky), shared_exponent_pack(sum.bounce), word));
    imageStore(cell_walls, texel, walls[slot]);
    contests[slot * CONTESTS + 1u] = 0xffffffffu;
}
