// Rays through the scene: a bounding volume hierarchy in two images of 32-bit words, read texel by texel. `scene::bvh` is the CPU
// counterpart and builds it; both give the same hits. On a software device fetches from images cost half of those from buffers.
//
// A node is two texels: lower corner, first triangle of a leaf; upper corner, the node after its subtree. The first child of an
// inner node is the next node, the second child the one after the first child's subtree; the node after a leaf is the next one.
// A triangle is three texels: corner, reflectance; first edge, emission; second edge, flags. See `passes/bounces/tree.rs`.

#include "random.glsl"

layout(set = 0, binding = 20) uniform usampler2D bvh_nodes;
layout(set = 0, binding = 21) uniform usampler2D bvh_triangles;

// Nodes and triangles in a row of their images, set by every pipeline that traces rays.
layout(constant_id = 31) const uint NODE_COLUMNS = 1u;
layout(constant_id = 32) const uint TRIANGLE_COLUMNS = 1u;
// Most nodes that a ray visits: the number of nodes, so that no loop is endless.
layout(constant_id = 33) const uint NODE_COUNT = 1u;

// Flags of a triangle: opacity times 255, whether it is the last one of its leaf.
const uint OPACITY = 0xffu;
const uint LAST = 0x100u;
// Depth of the tree, as in `scene::bvh`.
const int STACK = 48;
// Covers the rounding errors of the slab test (Ize 2013, "Robust BVH Ray Traversal").
const float ROUNDING = 1.0 + 4.0 * 1.1920929e-7;
const float FAR = 1e30;

struct Hit {
    float distance; // FAR: nothing was hit
    uint triangle;  // position in the image
    vec2 barycentrics; // weights of the second and third corner
};

ivec2 node_texel(uint node) {
    return ivec2(2u * (node % NODE_COLUMNS), node / NODE_COLUMNS);
}

ivec2 triangle_texel(uint triangle) {
    return ivec2(3u * (triangle % TRIANGLE_COLUMNS), triangle / TRIANGLE_COLUMNS);
}

struct Node {
    uvec4 lower;
    uvec4 upper;
};

Node node_at(uint node) {
    ivec2 at = node_texel(node);
    return Node(texelFetch(bvh_nodes, at, 0), texelFetch(bvh_nodes, at + ivec2(1, 0), 0));
}

/// Where a ray enters a node's box; FAR if it does not before `far`.
float node_entry(Node node, vec3 origin, vec3 inverse, float far) {
    vec3 a = (uintBitsToFloat(node.lower.xyz) - origin) * inverse;
    vec3 b = (uintBitsToFloat(node.upper.xyz) - origin) * inverse;
    vec3 low = min(a, b), high = max(a, b);
    float enter = max(max(low.x, low.y), max(low.z, 0.0));
    float leave = min(min(high.x, high.y), min(high.z, far));
    return enter <= leave * ROUNDING ? enter : FAR;
}

/// Whether a hit is on a surface and not in a hole of a cut-out: by chance, in proportion to the triangle's opacity.
bool is_solid(uint opacity, uint triangle, vec2 barycentrics) {
    uint hash = tea(triangle, floatBitsToUint(barycentrics.x) ^ (floatBitsToUint(barycentrics.y) << 1));
    return (hash & 0xffu) < opacity;
}

/// Intersects a triangle from both sides (Moller and Trumbore 1997); distance FAR if it is missed before `far`.
Hit triangle_hit(uint triangle, vec3 origin, vec3 toward, float far, out bool is_last) {
    ivec2 at = triangle_texel(triangle);
    vec3 corner = uintBitsToFloat(texelFetch(bvh_triangles, at, 0).xyz);
    vec3 edge1 = uintBitsToFloat(texelFetch(bvh_triangles, at + ivec2(1, 0), 0).xyz);
    uvec4 third = texelFetch(bvh_triangles, at + ivec2(2, 0), 0);
    vec3 edge2 = uintBitsToFloat(third.xyz);
    is_last = (third.w & LAST) != 0u;
    vec3 p = cross(toward, edge2);
    float inverse = 1.0 / dot(edge1, p);
    vec3 s = origin - corner;
    float u = dot(s, p) * inverse;
    vec3 q = cross(s, edge1);
    float v = dot(toward, q) * inverse;
    float distance = dot(edge2, q) * inverse;
    // False for NaN, which a ray in the triangle's plane gives.
    bool is_met = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 && distance < far;
    uint opacity = third.w & OPACITY;
    if (is_met && opacity != OPACITY) is_met = is_solid(opacity, triangle, vec2(u, v));
    return Hit(is_met ? distance : FAR, triangle, vec2(u, v));
}

/// The nearest hit from `origin` along `toward`, before the distance `far`.
Hit closest(vec3 origin, vec3 toward, float far) {
    vec3 inverse = 1.0 / toward;
    Hit best = Hit(far, 0u, vec2(0.0));
    uint stack[STACK];
    int depth = 0;
    uint at = 0u;
    Node node = node_at(at);
    bool is_entered = node_entry(node, origin, inverse, far) != FAR;
    for (uint visited = 0u; is_entered && visited < NODE_COUNT; ++visited) {
        if (node.upper.w == at + 1u) {
            bool is_last = false;
            for (uint triangle = node.lower.w; !is_last; ++triangle) {
                Hit hit = triangle_hit(triangle, origin, toward, best.distance, is_last);
                if (hit.distance < best.distance) best = hit;
            }
            if (depth == 0) break;
            at = stack[--depth];
            node = node_at(at);
            continue;
        }
        // The nearer child is next, the farther one waits.
        uint first = at + 1u;
        Node left = node_at(first);
        uint second = left.upper.w;
        Node right = node_at(second);
        float near_left = node_entry(left, origin, inverse, best.distance);
        float near_right = node_entry(right, origin, inverse, best.distance);
        bool is_left = near_left <= near_right;
        if (min(near_left, near_right) == FAR) {
            if (depth == 0) break;
            at = stack[--depth];
            node = node_at(at);
            continue;
        }
        if (max(near_left, near_right) != FAR) stack[depth++] = is_left ? second : first;
        at = is_left ? first : second;
        if (is_left) node = left; else node = right;
    }
    if (best.distance >= far) best.distance = FAR;
    return best;
}

/// Whether anything is hit from `origin` along `toward`, before the distance `far`.
bool any_hit(vec3 origin, vec3 toward, float far) {
    vec3 inverse = 1.0 / toward;
    uint at = 0u;
    for (uint visited = 0u; visited < NODE_COUNT && at < NODE_COUNT; ++visited) {
        Node node = node_at(at);
        bool is_leaf = node.upper.w == at + 1u;
        if (node_entry(node, origin, inverse, far) == FAR) {
            at = node.upper.w;
            continue;
        }
        ++at;
        if (!is_leaf) continue;
        bool is_last = false;
        for (uint triangle = node.lower.w; !is_last; ++triangle) {
            if (triangle_hit(triangle, origin, toward, far, is_last).distance < far) return true;
        }
    }
    return false;
}
