// Rays through the scene: a bounding volume hierarchy in two images of 32-bit words, read texel by texel. On a software device
// fetches from images cost half of those from buffers, so nodes are wide and small. `passes/bounces/tree.rs` makes the images from
// `scene::bvh`, whose rays hit the same triangles on the CPU.
//
// A node is three texels with the boxes of up to four children, in steps of a grid of its own: origin of the grid, exponents of its
// steps and numbers of triangles of the children; lower and upper corners of the children, four bytes a word; first child, first
// triangle. A child without triangles is a node; those and the triangles follow each other in the order of the children. The box of
// a child that does not exist is inside out.
// A triangle is three texels: corner, reflectance; first edge, emission (kcd/m^2, see shared_exponent.glsl); second edge, opacity, with the
// mean normal of the corners for a cut-out, or the mark and the internal transmittance of a pane of glass.
#include "glass.glsl"
#include "random.glsl"
#include "texel.glsl"

layout(set = 0, binding = 20) uniform usampler2D bvh_nodes;
layout(set = 0, binding = 21) uniform usampler2D bvh_triangles;

// Nodes and triangles in a row of their images, set by every pipeline that traces rays.
layout(constant_id = 31) const uint NODE_COLUMNS = 1u;
layout(constant_id = 32) const uint TRIANGLE_COLUMNS = 1u;
// Most steps of a ray, no fewer than there are nodes and leaves: no loop is endless, whatever a faulty driver makes of the images.
layout(constant_id = 33) const uint MOST_STEPS = 1u;

// Opacity times 255; of a cut-out, the octahedral coordinates of its normal are above it, NORMAL_BITS each.
const uint OPACITY = 0xffu;
const uint OPACITY_BITS = 8u, NORMAL_BITS = 11u;
// Mark of a pane of glass; its internal transmittance times 65535 is in the lower half of the word.
const uint PANE = 1u << 31;
// Mark of a pane that is a slab: only the face where light enters counts.
const uint SLAB = 1u << 30;
// What panes are to a ray: in the way of light by chance, walls, or nothing. In the last two, cut-outs are nothing or walls.
const uint PANES_DIM = 0u, PANES_BLOCK = 1u, PANES_ARE_OPEN = 2u, OPAQUE_ONLY = 3u, CUT_OUTS_BLOCK = 4u;
// Most children that wait, as `tree.rs` checks.
const int STACK = 64;
const float FAR = 1e30;
// Smallest magnitude of a component of a direction: its inverse must be finite.
const float TINY = 1e-20;

// Step of the grid in a pixel to which the corners of drawn triangles are moved, pixels.
layout(constant_id = 37) const float CORNER_STEP = 0.0;

// Offset of ray origins from their surface, relative to the largest coordinate: covers the rounding of float32.
const float LIFT = 3e-5;

// Leaves have the normals of their crown, so that they are lit through their own card: rays do not meet the cut-out from which they start, which
// is this many lifts away at most but for grazing rays.
const float OWN = 16.0;

float lift_at(vec3 position) {
    vec3 size = abs(position);
    return LIFT * (1.0 + max(size.x, max(size.y, size.z)));
}

vec3 lifted(vec3 position, vec3 normal) {
    return position + lift_at(position) * normal;
}

/// How far a point that is reconstructed from a picture may be off its surface, metres a metre from the eye. `size`: of the picture, pixels.
float corner_error(vec2 ray_scale, vec2 size) {
    vec2 pixel = 2.0 * abs(ray_scale) / size;
    return CORNER_STEP * max(pixel.x, pixel.y);
}

/// A point of a picture, seen from `eye`, lifted off its surface. `error`: of `corner_error`.
vec3 lifted_from(vec3 position, vec3 normal, vec3 eye, float error) {
    return position + (lift_at(position) + error * length(eye - position)) * normal;
}

/// The same, lifted toward the eye but for the error: nothing is in between, not even another wall of an acute corner.
vec3 lifted_to_eye(vec3 position, vec3 normal, vec3 eye, float error) {
    vec3 away = eye - position;
    float height = max(dot(away, normal), 0.05 * length(away));
    return position + away * min(lift_at(position) / height, 0.5) + error * length(away) * normal;
}

/// The same, lifted off its face to the side of a light: for faces that are seen from behind, too.
vec3 lifted_toward(vec3 position, vec3 face, vec3 toward, vec3 eye, float error) {
    return dot(face, toward) > 0.0 ? lifted_to_eye(position, face, eye, error) : lifted_from(position, -face, eye, error);
}

struct Hit {
    float distance;    // FAR: nothing was hit
    uint triangle;     // position in the image
    vec2 barycentrics; // weights of the second and third corner
};

/// The texels of a node and of a triangle.

uvec4 node_texel(uint node, uint i) {
    return texel_at(bvh_nodes, vec2(3u * (node % NODE_COLUMNS) + i, node / NODE_COLUMNS));
}

uvec4 triangle_texel(uint triangle, uint i) {
    return texel_at(bvh_triangles, vec2(3u * (triangle % TRIANGLE_COLUMNS) + i, triangle / TRIANGLE_COLUMNS));
}

vec3 inverse_of(vec3 toward) {
    vec3 size = max(abs(toward), TINY);
    return vec3(toward.x < 0.0 ? -1.0 : 1.0, toward.y < 0.0 ? -1.0 : 1.0, toward.z < 0.0 ? -1.0 : 1.0) / size;
}

vec4 bytes(uint word) {
    return vec4(word & 0xffu, (word >> 8) & 0xffu, (word >> 16) & 0xffu, word >> 24);
}

float power_of_two(uint exponent) {
    return uintBitsToFloat((exponent & 0xffu) << 23);
}

// A child as a word: number of its triangles, 0 to 3, in the two highest bits; node or first triangle.
const uint KIND = 30u;
const uint NUMBER = (1u << KIND) - 1u;

/// Where a ray enters the boxes of a node's children; FAR for those that it misses before `far`.
vec4 children_of(uint node, vec3 origin, vec3 inverse, float far, out uvec4 children) {
    uvec4 a = node_texel(node, 0u), b = node_texel(node, 1u), c = node_texel(node, 2u);
    vec3 steps = vec3(power_of_two(a.w), power_of_two(a.w >> 8), power_of_two(a.w >> 16)) * inverse;
    vec3 start = (uintBitsToFloat(a.xyz) - origin) * inverse;
    uvec3 low = b.xyz, high = uvec3(b.w, c.xy);
    bvec3 is_reversed = lessThan(inverse, vec3(0.0));
    uvec3 near = mix(low, high, is_reversed), away = mix(high, low, is_reversed);
    vec4 enter = max(max(bytes(near.x) * steps.x + start.x, bytes(near.y) * steps.y + start.y), max(bytes(near.z) * steps.z + start.z, 0.0));
    vec4 leave = min(min(bytes(away.x) * steps.x + start.x, bytes(away.y) * steps.y + start.y), min(bytes(away.z) * steps.z + start.z, far));
    uvec4 counts = (uvec4(a.w >> 24) >> uvec4(0u, 2u, 4u, 6u)) & 3u;
    uvec4 nodes = uvec4(equal(counts, uvec4(0u)));
    uvec4 before_nodes = uvec4(0u, nodes.x, nodes.x + nodes.y, nodes.x + nodes.y + nodes.z);
    uvec4 before = uvec4(0u, counts.x, counts.x + counts.y, counts.x + counts.y + counts.z);
    children = (counts << KIND) | mix(c.w + before, c.z + before_nodes, equal(counts, uvec4(0u)));
    return mix(vec4(FAR), enter, lessThanEqual(enter, leave));
}

/// Puts the nearer of two children first.
void order(inout float entry_a, inout float entry_b, inout uint a, inout uint b) {
    bool swaps = entry_b < entry_a;
    float entry = swaps ? entry_b : entry_a;
    uint child = swaps ? b : a;
    entry_b = swaps ? entry_a : entry_b;
    b = swaps ? a : b;
    entry_a = entry;
    a = child;
}

/// Sorts children, the nearest first.
void order_all(inout vec4 e, inout uvec4 c) {
    order(e.x, e.y, c.x, c.y);
    order(e.z, e.w, c.z, c.w);
    order(e.x, e.z, c.x, c.z);
    order(e.y, e.w, c.y, c.w);
    order(e.y, e.z, c.y, c.z);
}

/// A number in [0, 1) for a point of a triangle.
float chance(uint triangle, vec2 barycentrics) {
    uint hash = tea(triangle, floatBitsToUint(barycentrics.x) ^ (floatBitsToUint(barycentrics.y) << 1));
    return float(hash & 0xffffffu) / 16777216.0;
}

/// Whether a triangle is neither opaque nor a pane.
bool is_cut_out(uint word) {
    return word != OPACITY && (word & PANE) == 0u;
}

/// The part of the light along a ray that a pane stops.
float stopped(uint word, vec3 edge1, vec3 edge2, vec3 toward) {
    float cosine = dot(normalize(cross(edge1, edge2)), normalize(toward));
    vec3 internal = vec3(float(word & 0xffffu) / 65535.0);
    return 1.0 - pane_transmittance(internal, glass_surface(cosine)).x;
}

/// Whether a hit is on a surface and not in a hole of a cut-out or through glass: by chance, in proportion to the opacity.
bool is_solid(uint word, uint triangle, vec2 barycentrics, vec3 edge1, vec3 edge2, vec3 toward, uint panes) {
    bool is_pane = (word & PANE) != 0u;
    if (panes >= OPAQUE_ONLY) return panes == CUT_OUTS_BLOCK && !is_pane;
    if ((word & SLAB) != 0u && dot(cross(edge1, edge2), toward) > 0.0) return false;
    if (is_pane && panes != PANES_DIM) return panes == PANES_BLOCK;
    float opacity = is_pane ? stopped(word, edge1, edge2, toward) : float(word & OPACITY) / 255.0;
    return chance(triangle, barycentrics) < opacity;
}

/// Intersects a triangle from both sides (Moller and Trumbore 1997); distance FAR if it is missed before `far`.
Hit triangle_hit(uint triangle, vec3 origin, vec3 toward, float far, uint panes) {
    vec3 corner = uintBitsToFloat(triangle_texel(triangle, 0u).xyz);
    vec3 edge1 = uintBitsToFloat(triangle_texel(triangle, 1u).xyz);
    uvec4 third = triangle_texel(triangle, 2u);
    vec3 edge2 = uintBitsToFloat(third.xyz);
    vec3 p = cross(toward, edge2);
    float inverse = 1.0 / dot(edge1, p);
    vec3 s = origin - corner;
    float u = dot(s, p) * inverse;
    vec3 q = cross(s, edge1);
    float v = dot(toward, q) * inverse;
    float distance = dot(edge2, q) * inverse;
    // False for NaN, which a ray in the triangle's plane gives.
    bool is_met = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 && distance < far;
    if (is_met && is_cut_out(third.w) && distance < OWN * lift_at(origin)) is_met = false;
    if (is_met && third.w != OPACITY) is_met = is_solid(third.w, triangle, vec2(u, v), edge1, edge2, toward, panes);
    return Hit(is_met ? distance : FAR, triangle, vec2(u, v));
}

/// The nearest hit from `origin` along `toward`, before the distance `far`; with `any`, the first one that is found.
Hit traced(vec3 origin, vec3 toward, float far, bool any, uint panes) {
    vec3 inverse = inverse_of(toward);
    Hit best = Hit(far, 0u, vec2(0.0));
    uint waiting[STACK];
    float entries[STACK];
    int depth = 0;
    uint child = 0u;
    // A step visits a node or a triangle: on a software device both branches cost time in each.
    for (uint i = 0u; i < MOST_STEPS; ++i) {
        uint first = child & NUMBER;
        bool goes_on;
        if (child > NUMBER) {
            Hit hit = triangle_hit(first, origin, toward, best.distance, panes);
            if (hit.distance < best.distance) best = hit;
            if (any && best.distance < far) break;
            // The next one of the leaf.
            child += 1u - (1u << KIND);
            goes_on = child > NUMBER;
        } else {
            uvec4 c;
            vec4 e = children_of(first, origin, inverse, best.distance, c);
            order_all(e, c);
            if (e.w < FAR) { waiting[depth] = c.w; entries[depth++] = e.w; }
            if (e.z < FAR) { waiting[depth] = c.z; entries[depth++] = e.z; }
            if (e.y < FAR) { waiting[depth] = c.y; entries[depth++] = e.y; }
            child = c.x;
            goes_on = e.x < FAR;
        }
        if (goes_on) continue;
        while (depth > 0 && entries[depth - 1] >= best.distance) --depth;
        if (depth == 0) break;
        child = waiting[--depth];
    }
    if (best.distance >= far) best.distance = FAR;
    return best;
}

/// The nearest hit of light from `origin` along `toward`, before the distance `far`.
Hit closest(vec3 origin, vec3 toward, float far) {
    return traced(origin, toward, far, false, PANES_DIM);
}

/// Whether anything stops light from `origin` along `toward`, before the distance `far`.
bool any_hit(vec3 origin, vec3 toward, float far) {
    return traced(origin, toward, far, true, PANES_DIM).distance < far;
}

/// Whether a surface, panes included, is between `origin` and `far` along `toward`.
bool is_parted(vec3 origin, vec3 toward, float far) {
    return traced(origin, toward, far, true, PANES_BLOCK).distance < far;
}
