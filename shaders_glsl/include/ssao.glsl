#include "constants.glsl"
#include "face.glsl"
#include "occlusion.glsl"
#include "octahedral.glsl"
#include "texel.glsl"

// Therrien et al. 2023, "Screen Space Indirect Lighting with Visibility Bitmask": a slice through the view direction is divided
// into sectors, and each sample blocks those between its front and its back. As in Jimenez et al. 2016, "Practical Realtime
// Strategies for Accurate Indirect Occlusion" (GTAO), directions are cosine-weighted; here all sectors have equal weight.
// Every surface has the same thickness, as in Therrien et al. Extensions: samples as wide as their step, and extrapolation past
// the picture's edge.

layout(constant_id = 0) const int STEPS = 1;     // on each side of the slice
layout(constant_id = 1) const int DOWNSCALE = 1; // pixels of the G-buffer per occluder, along each axis
layout(constant_id = 2) const int SPACING = 1;   // occluders per point at which A is computed, along each axis

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform usampler2D normal_material;
layout(set = 0, binding = 2, scalar) uniform View { VIEW_BLOCK } view;

layout(push_constant, scalar) uniform Push {
    float radius; // metres
    float phase;  // decorrelates frames that are averaged, 0..1
} push;

const float SECTORS = 32.0;
// Sine of the elevation above the receiving face below which a sample belongs to the face and does not occlude: samples lie at
// pixel centres, beside the slice, where a plane seen at a grazing angle would look like a horizon.
const float FLAT = 0.02;
// Height above that face, of the distance from the eye, below which it may be noise of a rasteriser's depths: a tenth of a pixel.
const float NOISE = 2e-4;
// How far every surface reaches behind its front along the view ray, metres: a wall of one brick, 24 cm, or a floor slab. What is
// thicker hides too little of the sky from the ground behind it; a fence or a wall modelled as a sheet hides a strip that is
// narrow beside the radius.
const float THICKNESS = 0.25;

// The receiving point.
vec3 p;        // view space, metres
vec3 v;        // unit, toward the eye
vec3 n;        // unit
vec3 face;     // normal of the face itself, unit: with smooth normals, parts of the face rise above the plane of n
vec2 origin;   // texels
vec2 ray_step; // per texel, for rays with z = -1
vec2 ray_base; // of texel 0
vec2 pixel_size; // of the G-buffer's

vec3 point(vec2 texel, float distance) {
    return vec3(texel * ray_step + ray_base, -1.0) * distance;
}

// Like `texel_at`, with precomputed sizes.

vec3 normal_at(vec2 texel) {
    return normal_unpack(textureLod(normal_material, (texel * float(DOWNSCALE) + 0.5) * pixel_size, 0.0).r) * view.world_from_view;
}

/// Depth of a pixel, clamped to the picture's edge.
float depth_at(vec2 pixel) {
    return textureLod(depth, (pixel + 0.5) * pixel_size, 0.0).r;
}

/// Distance of an occluder along the view axis, metres.
float distance_at(vec2 texel) {
    return distance_of_depth(depth_at(texel * float(DOWNSCALE)), view.near);
}

/// Relative change of depth per pixel, toward the neighbour with the smaller change, which is assumed to be on the same face.
float depth_slope(vec2 pixel, vec2 unit, float d) {
    float before = depth_at(pixel - unit) - d;
    float after = depth_at(pixel + unit) - d;
    // At the picture's edge there is only one neighbour.
    bool is_first = any(lessThan(pixel - unit, vec2(0.0)));
    bool is_last = any(greaterThan(pixel + unit, vec2(textureSize(depth, 0) - 1)));
    return (is_first || (!is_last && abs(after) < abs(before)) ? after : -before) / d;
}

/// The normal of the face at a pixel; the shading normal if no neighbour lies on the same face.
vec3 face_at(vec2 pixel) {
    float d = depth_at(pixel);
    vec2 slope = vec2(depth_slope(pixel, vec2(1.0, 0.0), d), depth_slope(pixel, vec2(0.0, 1.0), d)) * float(DOWNSCALE) / ray_step;
    vec3 normal = normal_of_slopes(slope, -p.xy / p.z);
    return dot(normal, n) > SAME_FACE ? normal : n;
}

/// Half of a slice: the side of the view direction that its axis points to.
struct Side {
    vec3 axis;        // unit, perpendicular to the view direction
    vec2 n;           // the normal's projection on the slice, unit: along the axis, along the view direction
    vec2 stride;      // texels of a step of the radius
    float sectors;    // of this side, up to the tangent plane
    float per_weight; // sectors per unit of weight
};

/// Weight of the directions between the view direction and one whose cosine to it is c: the integral over the angle h of
/// cos(h - angle of n) sin h, which is (sin^2 h n.y + (h - sin h cos h) n.x) / 2. The polynomial for
/// asin c + c sqrt(1 - c^2) errs by less than 0.003.
float weight(float c, vec2 n) {
    float c2 = c * c;
    return 0.5 * ((1.0 - c2) * n.y + (0.5 * PI - c * (1.9836721 - c2 * (0.2379583 + 0.1722095 * c2))) * n.x);
}

/// 1 / sqrt x with an error below 0.2 %: an initial guess from the exponent and one Newton step (Lomont 2003, "Fast inverse square
/// root"). A software device computes `inversesqrt` with a square root and a division.
float rsqrt(float x) {
    float y = uintBitsToFloat(0x5f375a86u - (floatBitsToUint(x) >> 1));
    return y * (1.5 - 0.5 * x * y * y);
}

/// Sectors between the view direction and a point q of the slice (along the axis, along the view direction, metres).
float sectors_to(vec2 q, Side side) {
    float sectors = weight(q.y * rsqrt(dot(q, q) + 1e-20), side.n) * side.per_weight;
    // Below the tangent plane all sectors are blocked.
    return dot(q, side.n) > 0.0 ? sectors : side.sectors;
}

/// Bit mask of the first `count` sectors.
uint below(float count) {
    int whole = clamp(int(count), 0, 32);
    return whole >= 32 ? 0xffffffffu : (1u << whole) - 1u;
}

uint between(float a, float b, float dither) {
    return below(max(a, b) + dither) & ~below(min(a, b) + dither);
}

/// The sectors that one sample blocks: a box, as seen from p, from the sample's front to its back and as wide as the step.
uint blocked_by(vec2 texel, Side side, float half_width, float dither) {
    float distance = distance_at(texel);
    vec3 delta = point(texel, distance) - p;
    float r2 = dot(delta, delta);
    float over_face = dot(delta, face);
    vec2 q = vec2(abs(dot(delta, side.axis)), dot(delta, v));
    // The back is clamped to the sphere of the radius, with a parabola for sqrt(1 - t) of its circle.
    float t = min(q.x * q.x / (push.radius * push.radius), 1.0);
    float back = max(q.y - THICKNESS, -push.radius * (1.0 - t * (0.5 + 0.5 * t)));
    float h = half_width * distance;
    float front_at = sectors_to(vec2(max(q.x - sign(q.y) * h, 0.0), q.y), side);
    float back_at = sectors_to(vec2(max(q.x + sign(back) * h, 0.0), back), side);
    bool occludes = r2 < push.radius * push.radius && over_face > -NOISE * p.z && over_face * over_face > FLAT * FLAT * r2;
    return occludes ? between(front_at, back_at, dither) : 0u;
}

/// The sectors blocked past the picture's edge, where the surface at the edge is extrapolated as a plane up to the radius.
uint blocked_past(vec2 texel, Side side, float dither) {
    vec3 m = normal_at(texel);
    vec3 delta = point(texel, distance_at(texel)) - p;
    vec2 q = vec2(dot(delta, side.axis), dot(delta, v));
    vec2 away = vec2(dot(m, v), -dot(m, side.axis));
    float room = push.radius * push.radius - dot(q, q);
    if (away.x <= 0.0 || room <= 0.0) return 0u;
    away *= inversesqrt(dot(away, away));
    float b = dot(q, away);
    float reach = sqrt(b * b + room) - b;
    // The receiver's plane does not occlude itself.
    float over_face = dot(delta, face) + reach * (away.x * dot(face, side.axis) + away.y * dot(face, v));
    if (over_face <= FLAT * push.radius - NOISE * p.z) return 0u;
    return between(sectors_to(q, side), sectors_to(q + away * reach, side), dither);
}

/// The sectors blocked by surfaces on one side.
uint blocked_sectors(Side side, float jitter, float dither) {
    vec2 size = vec2((textureSize(depth, 0) + DOWNSCALE - 1) / DOWNSCALE);
    vec2 room = abs((mix(vec2(0.5), size - 0.5, greaterThan(side.stride, vec2(0.0))) - origin) / side.stride);
    float last = min(room.x, room.y);
    float first = 1.5 * inversesqrt(dot(side.stride, side.stride));
    float half_width = push.radius / (float(STEPS) * -p.z);
    uint sectors = 0u;
    for (int i = 0; i < STEPS; ++i) {
        // Steps grow with distance.
        float s = (float(i) + jitter) / float(STEPS);
        vec2 texel = floor(origin + side.stride * min(max(s * s, first), last));
        sectors |= blocked_by(texel, side, half_width * s, dither);
    }
    if (last < 1.0) sectors |= blocked_past(floor(origin + side.stride * last), side, dither);
    return sectors;
}

/// 1 - A from the slice at the angle `turn` (0..1, in half turns).
float slice_occlusion(float turn, float jitter, float dither, float distance) {
    // Slices are evenly distributed about v, which deviates from the image plane's normal toward the picture's edges.
    vec3 right = normalize(vec3(v.z, 0.0, -v.x));
    vec3 axis = right * cos(turn * PI) + cross(v, right) * sin(turn * PI);
    vec2 slice_n = vec2(dot(n, axis), dot(n, v));
    float length_n = max(length(slice_n), 1e-4);
    slice_n /= length_n;
    // Each side ends at the tangent plane, whose cosines to the view direction are -n.x and n.x.
    float plus_weight = weight(-slice_n.x, slice_n);
    float minus_weight = weight(slice_n.x, vec2(-slice_n.x, slice_n.y));
    float both = plus_weight + minus_weight;
    // The perspective image of a step of the radius along the axis.
    vec2 stride = (axis.xy - axis.z * p.xy / p.z) * push.radius / (distance * ray_step);
    Side plus = Side(axis, slice_n, stride, SECTORS * plus_weight / both, SECTORS / both);
    Side minus = Side(-axis, vec2(-slice_n.x, slice_n.y), -stride, SECTORS * minus_weight / both, SECTORS / both);
    uint before = blocked_sectors(plus, jitter, dither), after = blocked_sectors(minus, jitter, dither);
    return length_n * both * float(bitCount(before) + bitCount(after)) / SECTORS;
}

/// Whether a point has a surface.
bool is_surface_at(ivec2 own) {
    return texel_at(depth, vec2(own * SPACING * DOWNSCALE)).r > 0.0;
}

/// A and the distance along the view axis at a point with a surface, packed.
uint slice_at(ivec2 own) {
    vec2 texel = vec2(own * SPACING);
    vec2 full_size = vec2(textureSize(normal_material, 0));
    ray_step = 2.0 * float(DOWNSCALE) / full_size * view.ray_scale;
    ray_base = view_ray(0.5 / full_size, view.ray_scale, view.ray_offset).xy;
    pixel_size = 1.0 / full_size;
    float distance = distance_at(texel);
    p = point(texel, distance);
    v = normalize(-p);
    n = normal_at(texel);
    face = face_at(texel * float(DOWNSCALE));
    origin = texel + 0.5;
    // A 4x4 pattern of directions and step offsets, after Jimenez et al., which the blur removes. Between frames the phase advances
    // each by a different factor; the factors are coprime, so that they do not repeat together.
    ivec2 cell = own & 3;
    float turn = fract(float(((cell.x + cell.y) & 3) * 4 + cell.x) / 16.0 + push.phase);
    float jitter = fract(float((cell.y - cell.x) & 3) * 0.25 + 0.125 + push.phase * 7.0);
    // By the golden ratio, not as a sum of the two above, which would repeat within the pattern.
    float dither = fract(float(4 * cell.y + cell.x) * 0.6180340 + 0.5 + push.phase * 5.0);
    // Not clamped to 0: the occlusion of a single slice may exceed 1 (up to pi/2), and only the mean over many slices is A.
    return occlusion_pack(1.0 - slice_occlusion(turn, jitter, dither, distance), distance);
}
