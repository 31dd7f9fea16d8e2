#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scene_light.glsl"
#include "cell_grid.glsl"
#include "cell_table.glsl"
#include "cell_gradient.glsl"
#include "shared_exponent.glsl"

// Copies the live cells to the images that lookups read, and opens the contests for their points again. Cells with few paths are
// noisy: their light is smoothed over the neighbours that they see.

layout(local_size_x = 64) in;

TABLE;
PLACES;
CONTESTED;
SUMS;

layout(set = 0, binding = 8, rgba32ui) uniform writeonly uimage2DArray cells;
layout(set = 0, binding = 9, rgba32ui) uniform writeonly uimage2DArray cell_planes;

layout(push_constant, scalar) uniform Push {
    uint first; // as those of the update
    uint turns;
} push;

// Paths after which the smoothing fades out.
const float SMOOTHED = 512.0;
// Paths for which the light of larger cells counts: a new cell begins with it, as lookups did before.
const float PRIOR = 16.0;

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

/// Sums of light of cells, and of the weights.
struct Mean {
    vec3 sky;
    vec3 bounce;
    vec3 sky_gradient;
    vec3 bounce_gradient;
    float weight;
};

const Mean NO_LIGHT = Mean(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0);

void add(inout Mean mean, Mean other, float weight) {
    mean.sky += weight * other.sky;
    mean.bounce += weight * other.bounce;
    mean.sky_gradient += weight * other.sky_gradient;
    mean.bounce_gradient += weight * other.bounce_gradient;
    mean.weight += weight;
}

void add(inout Mean mean, Sum sum, float weight) {
    add(mean, Mean(sum.sky, sum.bounce, sum.sky_gradient, sum.bounce_gradient, 1.0), weight);
}

void scale(inout Mean mean, float factor) {
    mean.sky *= factor;
    mean.bounce *= factor;
    mean.sky_gradient *= factor;
    mean.bounce_gradient *= factor;
}

/// The light of a cell and its neighbours along the surface.
Mean smoothed(Sum own, vec3 p, vec3 n, int level) {
    uint side = dominant(n), axis = side % 3u;
    vec3 place = turned(in_grid(p, n, cell_edge(level)), axis), slope = turned(n, axis);
    float fade = own.samples / SMOOTHED;
    float spread = 1.0 / (1.0 + fade * fade);
    Mean mean = NO_LIGHT;
    add(mean, own, own.samples);
    for (int i = 0; i < 8; ++i) {
        if ((own.hidden & 1u << i) != 0u) continue;
        vec2 way = floor(place.xy) + vec2(NEIGHBOURS[i]) + 0.5 - place.xy;
        uint neighbour = slot_at(cell_beside(place, slope, way, axis), side, level, p);
        if (neighbour == NONE) continue;
        // A tent: half beside, a quarter at the corners.
        add(mean, sums[neighbour], spread * sums[neighbour].samples * ((i & 1) == 0 ? 0.5 : 0.25));
    }
    return mean;
}

/// The light of the cells of a level around a point that the one of the point sees: a quadratic B-spline, as wide as the tent and the
/// interpolation of lookups. `has_own`: there is a cell of the point.
Mean interpolated(vec3 p, vec3 n, int level, out bool has_own) {
    uint side = dominant(n), axis = side % 3u;
    vec3 place = turned(in_grid(p, n, cell_edge(level)), axis), slope = turned(n, axis);
    vec2 f = fract(place.xy) - 0.5;
    vec2 w[3] = vec2[](0.5 * (0.5 - f) * (0.5 - f), 0.75 - f * f, 0.5 * (0.5 + f) * (0.5 + f));
    uint own = slot_at(cell_beside(place, slope, -f, axis), side, level, p);
    has_own = own != NONE;
    uint hidden = has_own ? sums[own].hidden : 0u;
    Mean mean = NO_LIGHT;
    for (int i = 0; i < 9; ++i) {
        ivec2 k = ivec2(i % 3, i / 3);
        if ((hidden & neighbour_bit(k - 1)) != 0u) continue;
        uint slot = slot_at(cell_beside(place, slope, vec2(k - 1) - f, axis), side, level, p);
        if (slot != NONE) add(mean, sums[slot], w[k.x].x * w[k.y].y * sums[slot].samples);
    }
    return mean;
}

/// The published light of a cell.
Sum published(uint slot) {
    Sum own = sums[slot];
    Point anchor = points[slot * POINTS];
    int level = int(own.hidden >> 8);
    vec3 p = anchor.position, n = normal_unpack(anchor.normal);
    Mean fine = smoothed(own, p, n, level);
    bool has_own;
    if (own.samples < 2.0 * YOUNG) {
        Mean prior = interpolated(p, n, level + LARGER, has_own);
        if (has_own && prior.weight > 0.0) {
            scale(prior, 1.0 / prior.weight);
            add(fine, prior, PRIOR);
        }
    }
    scale(fine, fine.weight > 0.0 ? 1.0 / fine.weight : 0.0);
    // At its outer end a level continues as the next.
    float share = smoothstep(1.0 - BAND, 1.0, level_at(distance(p, scene.eye)) - float(level));
    if (share > 0.0) {
        Mean coarse = interpolated(p, n, level + 1, has_own);
        if (coarse.weight > 0.0) {
            scale(fine, 1.0 - share);
            add(fine, coarse, share / coarse.weight);
        }
    }
    return Sum(fine.sky, fine.bounce, fine.sky_gradient, fine.bounce_gradient, own.samples, own.hidden);
}

/// Publishes live cell number `index`.
void publish(uint index) {
    uint slot = live[index];
    // What is young got paths, and so did what has just ceased to be.
    bool is_young = sums[slot].samples < YOUNG + float(MOST_PATHS);
    if (!is_young && !is_seen(stamps[slot], scene.frame) && !is_due(index, live_count, push.first, push.turns)) return;
    ivec3 texel = ivec3(slot_texel(slot), 0);
    Sum sum = published(slot);
    uint word = uint(sum.samples) | (sum.hidden & 0xffu) << SAMPLE_BITS;
    imageStore(cells, texel, uvec4(prints[slot], irradiance_pack(sum.sky), irradiance_pack(sum.bounce), word));
    uvec2 gradients = uvec2(gradient_pack(sum.sky_gradient, luminance(sum.sky), sum.samples), gradient_pack(sum.bounce_gradient, luminance(sum.bounce), sum.samples));
    imageStore(cell_planes, texel, uvec4(walls[slot], gradients));
    contests[slot * CONTESTS] = 0xffffffffu;
}

void main() {
    uint first = gl_GlobalInvocationID.x;
    if (first == 0u) seen_count = 0u; // of the next round
    for (uint index = first; index < live_count; index += gl_NumWorkGroups.x * gl_WorkGroupSize.x) publish(index);
}
