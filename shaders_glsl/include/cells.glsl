// Lookups in the cells. Cells live in a hash table, whose published state is in two images: a slot is a texel.
// `passes/bounces/cells.rs` owns the table.
#include "cell_grid.glsl"
#include "cell_gradient.glsl"
#include "shared_exponent.glsl"
#include "texel.glsl"

// Print and flags; irradiance of the sky and of the bounces, klx; number of samples and hidden neighbours.
layout(set = 0, binding = 23) uniform usampler2D cells;
// Of divided cells: the plane of the wall (see cell_grid.glsl). How both irradiances depend on the normal (see cell_gradient.glsl).
layout(set = 0, binding = 24) uniform usampler2D cell_planes;

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

/// The published state of a cell; all 0 if there is none with samples.
struct State {
    uvec4 texel;
    uvec2 gradients; // of sky and bounces
};

vec3 sky_of(State state, vec3 n) {
    return irradiance_unpack(state.texel.y) * toward_normal(state.gradients.x, n);
}

vec3 bounce_of(State state, vec3 n) {
    return irradiance_unpack(state.texel.z) * toward_normal(state.gradients.y, n);
}

/// The state of the cell of a point at a place of the grid.
State cell_at(ivec3 at, uint side, int level, vec3 p) {
    State none = State(uvec4(0u), uvec2(0u));
    for (uint sibling = 0u; sibling < SIBLINGS; ++sibling) {
        uvec4 texel;
        uint slot = find_cell(cell_key(at, side, level, sibling), texel);
        if (slot == NONE) break;
        uvec4 plane = textureLod(cell_planes, slot_uv(slot), 0.0);
        if ((texel.x & DIVIDED) != 0u && !is_on_side(plane.xy, p)) continue;
        if (samples_of(texel) > 0u) return State(texel, plane.zw);
        break;
    }
    return none;
}

/// The light of the cell at a point of a level; not found if there is none with samples.
Cached cached_at(vec3 p, vec3 n, int level) {
    float edge = cell_edge(level);
    State state = cell_at(ivec3(floor(in_grid(p, n, edge))), dominant(n), level, p);
    return Cached(sky_of(state, n), bounce_of(state, n), samples_of(state.texel) > 0u);
}

/// The light at a point: of its cell, or of the next larger cell that exists.
Cached cached(vec3 p, vec3 n) {
    int level = cell_level(distance(p, scene.eye));
    Cached light = cached_at(p, n, level);
    for (int i = 1; i <= COARSER && !light.is_found; ++i) light = cached_at(p, n, level + i);
    return light;
}

/// Adds the light of the four cells of a level around a point, interpolated, and returns its weight: `scale` if there is a cell of the
/// point, which tells what is beyond a wall and does not count, and less without, or with `needs_own` nothing.
float add_interpolated(inout Cached light, float scale, vec3 p, vec3 n, int level, bool needs_own) {
    float edge = cell_edge(level);
    uint side = dominant(n), axis = side % 3u;
    vec3 place = turned(in_grid(p, n, edge), axis), slope = turned(n, axis);
    vec2 base = floor(place.xy - 0.5);
    vec2 f = place.xy - 0.5 - base;
    State states[4];
    for (int i = 0; i < 4; ++i) {
        vec2 cell = base + vec2(i & 1, i >> 1);
        states[i] = cell_at(cell_beside(place, slope, cell + 0.5 - place.xy, axis), side, level, p);
    }
    // The cell that the point is in.
    ivec2 own = ivec2(greaterThanEqual(f, vec2(0.5)));
    uint word = own.y == 0 ? own.x == 0 ? states[0].texel.w : states[1].texel.w : own.x == 0 ? states[2].texel.w : states[3].texel.w;
    if (word == 0u && needs_own) return 0.0;
    uint hidden = word >> SAMPLE_BITS;
    vec3 sky = vec3(0.0), bounce = vec3(0.0);
    float sum = 0.0, around = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        vec2 w = mix(1.0 - f, f, vec2(corner));
        // Young cells are noisy.
        float samples = float(samples_of(states[i].texel));
        float weight = (w.x * w.y + 1e-3) * samples / (samples + 4.0);
        if ((hidden & neighbour_bit(corner - own)) != 0u) weight = 0.0;
        sky += weight * sky_of(states[i], n);
        bounce += weight * bounce_of(states[i], n);
        sum += weight;
        if (samples > 0.0) around += w.x * w.y;
    }
    if (sum < 1e-5) return 0.0;
    float found = scale * (word != 0u ? 1.0 : around);
    light.sky += found / sum * sky;
    light.bounce += found / sum * bounce;
    return found;
}

/// The light at a point, interpolated between the cells around it. Until there is a cell of its own, those of larger ones fill the gap.
Cached interpolated(vec3 p, vec3 n) {
    int level = cell_level(distance(p, scene.eye));
    Cached light = Cached(vec3(0.0), vec3(0.0), false);
    float sum = 0.0;
    for (int i = 0; i <= COARSER && sum < 1.0; ++i) sum += add_interpolated(light, 1.0 - sum, p, n, level + i, i > 0);
    if (sum == 0.0) return light;
    return Cached(light.sky / sum, light.bounce / sum, true);
}
