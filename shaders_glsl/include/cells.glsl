// Lookups in the cells. Cells live in a hash table, whose published state is in two images: a slot is a texel.
// `passes/bounces/cells.rs` owns the table.
#include "cell_grid.glsl"
#include "shared_exponent.glsl"
#include "texel.glsl"

// Print and flags; irradiance of the sky and of the bounces, klx; number of samples and hidden neighbours.
layout(set = 0, binding = 23) uniform usampler2D cells;
// Of divided cells: the plane of the wall, unit normal toward the anchor, and its distance from the origin, metres.
layout(set = 0, binding = 24) uniform sampler2D walls;

vec2 slot_uv(uint slot) {
    return (vec2(slot_texel(slot)) + 0.5) / vec2(SLOT_COLUMNS, SLOTS / SLOT_COLUMNS);
}

/// The published slot of a cell, or NONE. `texel` receives its state.
uint find_cell(Key key, out uvec4 texel) {
    for (uint i = 0u; i < BUCKET; ++i) {
        texel = textureLod(cells, slot_uv(key.bucket + i), 0.0);
        if ((texel.x & ~FLAGS) == key.print) return key.bucket + i;
        // Buckets are filled in order.
        if (texel.x == 0u) break;
    }
    return NONE;
}

struct Cached {
    vec3 sky;    // klx
    vec3 bounce; // klx
    bool is_found;
};

uint samples_of(uvec4 texel) {
    return texel.w & ((1u << SAMPLE_BITS) - 1u);
}

/// The state of the cell of a point at a place of the grid; all 0 if there is none with samples.
uvec4 cell_at(ivec3 at, uint side, int level, vec3 p) {
    for (uint sibling = 0u; sibling < SIBLINGS; ++sibling) {
        uvec4 texel;
        uint slot = find_cell(cell_key(at, side, level, sibling), texel);
        if (slot == NONE) break;
        if ((texel.x & DIVIDED) != 0u && !is_on_side(textureLod(walls, slot_uv(slot), 0.0), p)) continue;
        return samples_of(texel) > 0u ? texel : uvec4(0u);
    }
    return uvec4(0u);
}

/// The light of the cell at a point of a level; not found if there is none with samples.
Cached cached_at(vec3 p, vec3 n, int level) {
    float edge = cell_edge(level);
    uvec4 texel = cell_at(ivec3(floor(in_grid(p, n, edge))), dominant(n), level, p);
    return Cached(shared_exponent_unpack(texel.y), shared_exponent_unpack(texel.z), samples_of(texel) > 0u);
}

/// The light at a point: of its cell, or of the next larger cell that exists.
Cached cached(vec3 p, vec3 n) {
    int level = cell_level(distance(p, scene.eye));
    Cached light = cached_at(p, n, level);
    for (int i = 1; i <= COARSER && !light.is_found; ++i) light = cached_at(p, n, level + i);
    return light;
}

/// The light at a point, interpolated between the four cells of its surface around it. Cells beyond a wall do not count.
Cached interpolated(vec3 p, vec3 n) {
    int level = cell_level(distance(p, scene.eye));
    float edge = cell_edge(level);
    uint side = dominant(n), axis = side % 3u;
    vec3 place = turned(in_grid(p, n, edge), axis), slope = turned(n, axis);
    vec2 base = floor(place.xy - 0.5);
    vec2 f = place.xy - 0.5 - base;
    uvec4 texels[4];
    for (int i = 0; i < 4; ++i) {
        vec2 cell = base + vec2(i & 1, i >> 1);
        texels[i] = cell_at(cell_beside(place, slope, cell + 0.5 - place.xy, axis), side, level, p);
    }
    // The cell that the point is in.
    ivec2 own = ivec2(greaterThanEqual(f, vec2(0.5)));
    uint hidden = (own.y == 0 ? own.x == 0 ? texels[0].w : texels[1].w : own.x == 0 ? texels[2].w : texels[3].w) >> SAMPLE_BITS;
    vec3 sky = vec3(0.0), bounce = vec3(0.0);
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        vec2 w = mix(1.0 - f, f, vec2(corner));
        // Young cells are noisy.
        float samples = float(samples_of(texels[i]));
        float weight = (w.x * w.y + 1e-3) * samples / (samples + 4.0);
        if ((hidden & neighbour_bit(corner - own)) != 0u) weight = 0.0;
        sky += weight * shared_exponent_unpack(texels[i].y);
        bounce += weight * shared_exponent_unpack(texels[i].z);
        sum += weight;
    }
    if (sum < 1e-4) return cached(p, n);
    return Cached(sky / sum, bounce / sum, true);
}
