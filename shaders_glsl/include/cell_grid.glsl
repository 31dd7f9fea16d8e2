// Cells: a cache of irradiance in world space. A cell is a cube of space together with a dominant direction of normals and a level
// of size; it holds the irradiance of the sky and of the bounces on the surfaces in it. This file says which cell a point belongs
// to. Needs `scene`, bvh.glsl.
#include "cell_flags.glsl"

// Most cells at one place, each for what is beyond the walls of the ones before.
const uint SIBLINGS = 4u;
// Levels that a lookup tries beyond its own.
const int COARSER = 4;
// Height above the surface at which points must see each other to share a cell, in edges of the cell.
const float SIGHT = 0.15;

/// What identifies a cell: its bucket, and its print among the cells there.
struct Key {
    uint bucket;
    uint print;
};

/// Level of the cells at a distance from the eye, metres, with its fraction: the edge doubles with each.
float level_at(float distance) {
    return max(log2(max(distance / scene.near, 1e-6)) + 1.0, 0.0);
}

int cell_level(float distance) {
    return int(level_at(distance));
}

// Last part of a level in which its cells blend into those of the next.
const float BAND = 0.3;

// How many levels larger those cells are that candidates create beside the ones of their place.
const int LARGER = 2;

/// Level of the cell for a candidate: some are for larger cells, which stand in where small ones are missing or blend into them.
int candidate_level(vec3 p, uint hash) {
    float mixed_level = level_at(distance(p, scene.eye)) + BAND * float(hash >> 24) / 255.0;
    return int(mixed_level) + ((hash & 0x700u) == 0u ? LARGER : 0);
}

float cell_edge(int level) {
    return scene.cell * exp2(float(level));
}

/// Axis of the largest component of a normal: 0 to 2; 3 more if it is negative.
uint dominant(vec3 n) {
    vec3 a = abs(n);
    uint axis = a.x >= a.y && a.x >= a.z ? 0u : a.y >= a.z ? 1u : 2u;
    return axis + (n[axis] < 0.0 ? 3u : 0u);
}

/// Position in the grid of a level, in edges. The shift along the normal keeps surfaces out of the borders, the other one walls at
/// round coordinates.
vec3 in_grid(vec3 p, vec3 n, float edge) {
    return p / edge + 0.37 * n + vec3(0.1547, 0.3719, 0.2331);
}

uint mixed(uint h) {
    h ^= h >> 16;
    h *= 0x7feb352du;
    h ^= h >> 15;
    h *= 0x846ca68bu;
    return h ^ (h >> 16);
}

Key cell_key(ivec3 at, uint side, int level, uint sibling) {
    uint h = mixed(uint(at.x) * 0x9e3779b1u ^ mixed(uint(at.y) * 0x85ebca77u ^ mixed(uint(at.z) * 0xc2b2ae3du ^ (side | uint(level) << 3 | sibling << 9))));
    // Not a function of h alone, so that cells of one bucket differ in it.
    uint print = mixed(h + uint(at.x) * 0x27d4eb2fu + uint(at.y) * 0x165667b1u + uint(at.z) * 0xd3a2646du);
    return Key((h & (BUCKETS - 1u)) * BUCKET, (print | (FLAGS + 1u)) & ~FLAGS);
}

/// The coordinates of a vector in the order: two along the sides of the grid that a surface of this axis follows, its own axis.
vec3 turned(vec3 v, uint axis) {
    return axis == 0u ? v.yzx : axis == 1u ? v.zxy : v.xyz;
}

/// The inverse of `turned`.
vec3 turned_back(vec3 v, uint axis) {
    return axis == 0u ? v.zxy : axis == 1u ? v.yzx : v.xyz;
}

/// Place of the cell beside a point whose middle is `way` from it along the sides of the grid.
ivec3 cell_beside(vec3 place, vec3 slope, vec2 way, uint axis) {
    // Where the tangent plane meets that middle.
    float height = place.z - dot(slope.xy, way) / slope.z;
    return ivec3(floor(turned_back(vec3(place.xy + way, height), axis)));
}

/// The plane of a wall through a point: its normal, octahedral, and its distance from the origin, metres.
uvec2 wall_pack(vec3 normal, vec3 p) {
    uint word = normal_pack(normal);
    return uvec2(word, floatBitsToUint(dot(normal_unpack(word), p)));
}

/// Whether a point is on the side of a wall to which its normal points: that of the anchor of the divided cell.
bool is_on_side(uvec2 wall, vec3 p) {
    return dot(normal_unpack(wall.x), p) >= uintBitsToFloat(wall.y);
}
