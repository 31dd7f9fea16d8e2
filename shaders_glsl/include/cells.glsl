// Lookups in the cells. Cells live in a hash table, whose published state is in three images: a slot is a texel.
// `passes/bounces/cells.rs` owns the table.
#include "cell_grid.glsl"

layout(set = 0, binding = 23) uniform usampler2D cells;      // x: print and flags; yzw: anchor, world, metres, as bits
layout(set = 0, binding = 24) uniform sampler2D cell_sky;    // rgb: irradiance of the sky, klx; a: number of samples
layout(set = 0, binding = 25) uniform sampler2D cell_bounce; // rgb: irradiance of the bounces, klx; a: number of samples

/// The published slot of a cell, or NONE. `texel` receives its texel of `cells`.
uint find_cell(Key key, out uvec4 texel) {
    for (uint i = 0u; i < BUCKET; ++i) {
        texel = texel_at(cells, vec2(slot_texel(key.bucket + i)));
        if ((texel.x & ~FLAGS) == key.print) return key.bucket + i;
    }
    return NONE;
}

struct Cached {
    vec3 sky;    // klx
    vec3 bounce; // klx
    bool is_found;
};

/// The light of the cell at a point of a level; not found if there is none with samples.
Cached cached_at(vec3 p, vec3 n, int level) {
    float edge = cell_edge(level);
    ivec3 at = ivec3(floor(in_grid(p, n, edge)));
    uint side = dominant(n);
    for (uint sibling = 0u; sibling < SIBLINGS; ++sibling) {
        uvec4 texel;
        uint slot = find_cell(cell_key(at, side, level, sibling), texel);
        if (slot == NONE) break;
        if ((texel.x & MIXED) != 0u && !is_seen(uintBitsToFloat(texel.yzw), p, n, edge)) continue;
        vec4 sky = texel_at(cell_sky, vec2(slot_texel(slot)));
        if (sky.a == 0.0) break;
        return Cached(sky.rgb, texel_at(cell_bounce, vec2(slot_texel(slot))).rgb, true);
    }
    return Cached(vec3(0.0), vec3(0.0), false);
}

/// The light at a point: of its cell, or of the next larger cell that exists.
Cached cached(vec3 p, vec3 n) {
    int level = cell_level(distance(p, scene.eye));
    Cached light = cached_at(p, n, level);
    for (int i = 1; i <= COARSER && !light.is_found; ++i) light = cached_at(p, n, level + i);
    return light;
}
