#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "constants.glsl"
#include "occluder.glsl"
#include "octahedral.glsl"
#include "view.glsl"

// Therrien et al. 2023, "Screen Space Indirect Lighting with Visibility Bitmask": a slice through the view direction is cut
// into sectors, and each sample blocks those between its front and its back. As in Jimenez et al. 2016, "Practical Realtime
// Strategies for Accurate Indirect Occlusion" (GTAO), directions count by their cosine: sectors are cut to count the same.
// Added here: backs by the thickness of bodies, samples as wide as their step, and a picture that goes on past its edge.

layout(location = 0) out uint occlusion; // A and the distance along the view axis, packed

layout(constant_id = 0) const int STEPS = 12;    // on each side of the slice
layout(constant_id = 1) const int DOWNSCALE = 2; // pixels of the G-buffer to one of the occluders, each way
layout(constant_id = 2) const bool SPARSE = true; // every second of the occluders, as the black fields of a chessboard

layout(set = 0, binding = 0) uniform usampler2D occluders;
layout(set = 0, binding = 1) uniform usampler2D normal;
layout(set = 0, binding = 2, scalar) uniform View { VIEW_BLOCK } view;

layout(push_constant, scalar) uniform Push {
    float radius; // metres
    float phase;  // decorrelates frames that are averaged, 0..1
} push;

const float SECTORS = 32.0;
// What rises less than this over the tangent plane (a sine) is that plane, not an occluder: samples lie at pixel centres,
// beside the slice, where a plane seen at a grazing angle would pass for a horizon.
const float FLAT = 0.02;

// The point that is lit.
vec3 p;        // view space, metres
vec3 v;        // unit, toward the eye
vec3 n;        // unit
vec2 origin;   // texels
vec2 ray_step; // of a texel, of rays with z = -1
vec2 ray_base; // of texel 0

vec3 point(ivec2 texel, float distance) {
    return vec3(vec2(texel) * ray_step + ray_base, -1.0) * distance;
}

vec3 normal_at(ivec2 texel) {
    return normal_unpack(texelFetch(normal, texel * DOWNSCALE, 0).r) * view.world_from_view;
}

/// Half of a slice: the side of the view direction toward which its axis points.
struct Side {
    vec3 axis;        // unit, perpendicular to the view direction
    vec2 n;           // the normal's projection on the slice, unit: along the axis, along the view direction
    vec2 stride;      // texels of a step of the radius
    float sectors;    // of this side, up to the tangent plane
    float per_weight; // sectors of a unit of weight
};

/// Weight of the directions between the view direction and one whose cosine to it is c: the integral over the angle h of
/// cos(h - angle of n) sin h, which is (sin^2 h n.y + (h - sin h cos h) n.x) / 2. The polynomial for
/// asin c + c sqrt(1 - c^2) errs by less than 0.003.
float weight(float c, vec2 n) {
    float c2 = c * c;
    return 0.5 * ((1.0 - c2) * n.y + (0.5 * PI - c * (1.9836721 - c2 * (0.2379583 + 0.1722095 * c2))) * n.x);
}

/// Sectors between the view direction and a point q of the slice (along the axis, along the view direction, metres).
float sectors_to(vec2 q, Side side) {
    float sectors = weight(q.y * inversesqrt(dot(q, q) + 1e-20), side.n) * side.per_weight;
    // Behind the tangent plane everything is blocked by it.
    return dot(q, side.n) > 0.0 ? sectors : side.sectors;
}

/// Sectors from 0 to a count.
uint below(float count) {
    int whole = clamp(int(count), 0, 32);
    return whole >= 32 ? 0xffffffffu : (1u << whole) - 1u;
}

uint between(float a, float b, float dither) {
    return below(max(a, b) + dither) & ~below(min(a, b) + dither);
}

/// The sectors that one sample blocks: a box seen from p, from its front to its back, as wide as the step.
uint blocked_by(ivec2 texel, Side side, float half_width, float dither) {
    uint word = texelFetch(occluders, texel, 0).r;
    float distance = packed_distance(word);
    vec3 delta = point(texel, distance) - p;
    float r2 = dot(delta, delta);
    float over_plane = dot(delta, n);
    vec2 q = vec2(abs(dot(delta, side.axis)), dot(delta, v));
    // No farther back than the sphere of the radius: sqrt(1 - t) of its circle as a parabola.
    float t = min(q.x * q.x / (push.radius * push.radius), 1.0);
    float back = max(q.y - occluder_thickness(word), -push.radius * (1.0 - t * (0.5 + 0.5 * t)));
    float h = half_width * distance;
    float front_at = sectors_to(vec2(max(q.x - sign(q.y) * h, 0.0), q.y), side);
    float back_at = sectors_to(vec2(max(q.x + sign(back) * h, 0.0), back), side);
    bool occludes = r2 < push.radius * push.radius && over_plane > 0.0 && over_plane * over_plane > FLAT * FLAT * r2;
    return occludes ? between(front_at, back_at, dither) : 0u;
}

/// The sectors blocked past the picture's edge, where the surface at the edge goes on as a plane up to the radius.
uint blocked_past(ivec2 texel, Side side, float dither) {
    vec3 m = normal_at(texel);
    vec3 delta = point(texel, packed_distance(texelFetch(occluders, texel, 0).r)) - p;
    vec2 q = vec2(dot(delta, side.axis), dot(delta, v));
    vec2 away = vec2(dot(m, v), -dot(m, side.axis));
    float room = push.radius * push.radius - dot(q, q);
    if (away.x <= 0.0 || room <= 0.0) return 0u;
    away *= inversesqrt(dot(away, away));
    float b = dot(q, away);
    float reach = sqrt(b * b + room) - b;
    // The plane that is lit hides nothing of itself.
    float over_plane = dot(delta, n) + reach * (away.x * dot(n, side.axis) + away.y * dot(n, v));
    if (over_plane <= FLAT * push.radius) return 0u;
    return between(sectors_to(q, side), sectors_to(q + away * reach, side), dither);
}

/// The sectors that surfaces on one side block.
uint blocked_sectors(Side side, float jitter, float dither) {
    vec2 size = vec2(textureSize(occluders, 0));
    vec2 room = abs((mix(vec2(0.5), size - 0.5, greaterThan(side.stride, vec2(0.0))) - origin) / side.stride);
    float last = min(room.x, room.y);
    float first = 1.5 * inversesqrt(dot(side.stride, side.stride));
    float half_width = push.radius / (float(STEPS) * -p.z);
    uint sectors = 0u;
    for (int i = 0; i < STEPS; ++i) {
        // Steps grow with the distance.
        float s = (float(i) + jitter) / float(STEPS);
        ivec2 texel = ivec2(origin + side.stride * min(max(s * s, first), last));
        sectors |= blocked_by(texel, side, half_width * s, dither);
    }
    if (last < 1.0) sectors |= blocked_past(ivec2(origin + side.stride * last), side, dither);
    return sectors;
}

void main() {
    ivec2 own = ivec2(gl_FragCoord.xy);
    ivec2 texel = SPARSE ? ivec2(2 * own.x + (own.y & 1), own.y) : own;
    float distance = packed_distance(texelFetch(occluders, texel, 0).r);
    if (distance >= 0.5 * NOWHERE) {
        occlusion = occlusion_pack(1.0, 0.0);
        return;
    }
    vec2 full_size = vec2(textureSize(normal, 0));
    ray_step = 2.0 * float(DOWNSCALE) / full_size * view.ray_scale;
    ray_base = view_ray(0.5 / full_size, view.ray_scale, view.ray_offset).xy;
    p = point(texel, distance);
    v = normalize(-p);
    n = normal_at(texel);
    origin = vec2(texel) + 0.5;
    // A pattern of 4x4 occluders of directions and step offsets, after Jimenez et al., taken out again by the 4x4 blur. Of the
    // sparse ones those are eight, two in a row.
    ivec2 cell = own & 3;
    float order = SPARSE ? float(((cell.x & 1) * 4 + (cell.y & 1) * 2 + (cell.y >> 1))) / 8.0
                         : float(((cell.x + cell.y) & 3) * 4 + cell.x) / 16.0;
    float turn = fract(order + push.phase);
    float offset = SPARSE ? float((cell.y * 3 + (cell.x & 1) * 2) & 3) : float((cell.y - cell.x) & 3);
    float jitter = fract(offset * 0.25 + 0.125 + push.phase * 7.0);
    float dither = fract(turn * 7.0 + jitter);
    // The slice turns evenly about v, which leaves the image plane's normal toward the picture's edges.
    vec3 right = normalize(vec3(v.z, 0.0, -v.x));
    vec3 axis = right * cos(turn * PI) + cross(v, right) * sin(turn * PI);
    vec2 slice_n = vec2(dot(n, axis), dot(n, v));
    float length_n = max(length(slice_n), 1e-4);
    slice_n /= length_n;
    // Each side up to the tangent plane, whose cosines to the view direction are -n.x and n.x.
    float plus_weight = weight(-slice_n.x, slice_n);
    float minus_weight = weight(slice_n.x, vec2(-slice_n.x, slice_n.y));
    float both = plus_weight + minus_weight;
    // The perspective image of a step of the radius along the axis.
    vec2 stride = (axis.xy - axis.z * p.xy / p.z) * push.radius / (distance * ray_step);
    Side plus = Side(axis, slice_n, stride, SECTORS * plus_weight / both, SECTORS / both);
    Side minus = Side(-axis, vec2(-slice_n.x, slice_n.y), -stride, SECTORS * minus_weight / both, SECTORS / both);
    int count = bitCount(blocked_sectors(plus, jitter, dither)) + bitCount(blocked_sectors(minus, jitter, dither));
    // Not cut at 0: a single slice may block more than its share (up to pi/2), and only the mean over many is A.
    occlusion = occlusion_pack(1.0 - length_n * both * float(count) / SECTORS, distance);
}
