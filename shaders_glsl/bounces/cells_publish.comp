#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "cell_flags.glsl"
#include "cell_table.glsl"
#include "shared_exponent.glsl"

// Copies the live cells to the images that lookups read, and opens the contests for their points again.

layout(local_size_x = 64) in;

PRINTS;
LIVE;
CONTESTED;
WALLS;
SUMS;

layout(set = 0, binding = 8, rgba32ui) uniform writeonly uimage2DArray cells;
layout(set = 0, binding = 9, rgba32f) uniform writeonly image2DArray cell_walls;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= live_count) return;
    uint slot = live[index];
    ivec3 texel = ivec3(slot_texel(slot), 0);
    Sum sum = sums[slot];
    uint word = uint(sum.samples) | sum.hidden << SAMPLE_BITS;
    imageStore(cells, texel, uvec4(prints[slot], shared_exponent_pack(sum.sky), shared_exponent_pack(sum.bounce), word));
    imageStore(cell_walls, texel, walls[slot]);
    contests[slot * CONTESTS + 1u] = 0xffffffffu;
}
