// Lookups in the cells. Cells live in a hash table, whose published state is in two images: a slot is a texel.
// `passes/bounces/cells.rs` owns the table.
#include "cell_grid.glsl"
#include "shared_exponent.glsl"

layout(set = 0, binding = 23) uniform usampler2D cells; // print and flags, irradiance of the sky and of the bounces (klx), samples
layout(set = 0, binding = 24) uniform sampler2D anchors; // xyz: anchor of a cell, world, metres

/// The published slot of a cell, or NONE. `texel` receives its state.
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

/// The state of the cell of surfaces that a point sees, the one at a place of the grid or a sibling; all 0 if there is none with
/// samples. `flags`: those that ask for a test.
uvec4 seen_cell(ivec3 at, uint side, int level, vec3 p, vec3 n, float edge, uint flags) {
    for (uint sibling = 0u; sibling < SIBLINGS; ++sibling) {
        uvec4 texel;
        uint slot = find_cell(cell_key(at, side, level, sibling), texel);
        if (slot == NONE) break;
        if ((texel.x & flags) != 0u && !is_seen(texel_at(anchors, vec2(slot_texel(slot))).xyz, p, n, edge)) continue;
        return texel.w > 0u ? texel : uvec4(0u);
    }
    return uvec4(0u);
}

/// The light of the cell at a point of a level; not found if there is none with samples.
Cached cached_at(vec3 p, vec3 n, int level) {
    float edge = cell_edge(level);
    uvec4 texel = seen_cell(ivec3(floor(in_grid(p, n, edge))), dominant(n), level, p, n, edge, MIXED);
    return Cached(shared_exponent_unpack(texel.y), shared_exponent_unpack(texel.z), texel.w > 0u);
}

/// The light at a point: of its cell, or of the next larger cell that exists.
Cached cached(vec3 p, vec3 n) {
    int level = cell_level(distance(p, scene.eye));
    Cached light = cached_at(p, n, level);
    for (int i = 1; i <= COARSER && !light.is_found; ++i) light = cached_at(p, n, level + i);
    return light;
}

/// The coordinates of a vector in the order: two along the sides of the grid that a surface of this axis follows, its own axis.
vec3 turned(vec3 v, uint axis) {
    return axis == 0u ? v.yzx : axis == 1u ? v.zxy : v.xyz;
}

/// The inverse of `turned`.
vec3 turned_back(vec3 v, uint axis) {
    return axis == 0u ? v.zxy : axis == 1u ? v.yzx : v.xyz;
}

/// The light at a point, interpolated between the four cells of its surface around it. Cells beyond a wall do not count.
Cached interpolated(vec3 p, vec3 n) {
    int level = cell_level(distance(p, scene.eye));
    float edge = cell_edge(level);
    uint side = dominant(n), axis = side % 3u;
    vec3 place = turned(in_grid(p, n, edge), axis), slope = turned(n, axis);
    vec2 base = floor(place.xy - 0.5);
    vec2 f = place.xy - 0.5 - base;
    vec3 sky = vec3(0.0), bounce = vec3(0.0);
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 corner = vec2(i & 1, i >> 1);
        vec2 cell = base + corner;
        // Where the tangent plane meets the middle of that cell.
        float height = place.z - dot(slope.xy, cell + 0.5 - place.xy) / slope.z;
        ivec3 at = ivec3(turned_back(vec3(cell, floor(height)), axis));
        uvec4 texel = seen_cell(at, side, level, p, n, edge, MIXED | EDGED);
        vec2 w = mix(1.0 - f, f, corner);
        // Young cells are noisy.
        float samples = float(texel.w);
        float weight = (w.x * w.y + 1e-3) * samples / (samples + 4.0);
        sky += weight * shared_exponent_unpack(texel.y);
        bounce += weight * shared_exponent_unpack(texel.z);
        sum += weight;
    }
    if (sum < 1e-4) return cached(p, n);
    return Cached(sky / sum, bounce / sum, true);
}
