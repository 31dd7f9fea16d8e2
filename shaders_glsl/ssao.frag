#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "constants.glsl"
#include "octahedral.glsl"
#include "view.glsl"

// Jimenez et al. 2016, "Practical Realtime Strategies for Accurate Indirect Occlusion" (GTAO): in each slice through the
// view direction the two horizons within the radius bound a cosine-weighted arc, whose integral is known in closed form.

layout(location = 0) out vec2 occlusion; // A, distance along the view axis (m)

layout(constant_id = 0) const int SLICES = 2;
layout(constant_id = 1) const int STEPS = 6;
layout(constant_id = 2) const int DOWNSCALE = 2; // pixels of depth to one of this target, each way

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform sampler2D normal;
layout(set = 0, binding = 2, scalar) uniform View { VIEW_BLOCK } view;

layout(push_constant, scalar) uniform Push {
    float radius; // metres
    float phase;  // decorrelates frames that are averaged, 0..1
} push;

ivec2 full_size;

vec3 position_at(ivec2 pixel, float d) {
    vec2 uv = (vec2(pixel) + 0.5) / vec2(full_size);
    return view_ray(uv, view.ray_scale, view.ray_offset) * (view.near / d);
}

/// acos with an error below 7e-5 (Hastings); the library's costs three times as much on a CPU.
float fast_acos(float x) {
    float a = abs(x);
    float r = ((-0.0187293 * a + 0.0742610) * a - 0.2121144) * a + 1.5707288;
    r *= sqrt(max(1.0 - a, 0.0));
    return x >= 0.0 ? r : PI - r;
}

// What rises less than this over the tangent plane (a sine) is that plane, not an occluder: samples lie at pixel centres,
// beside the slice, where a plane seen at a grazing angle would pass for a horizon.
const float FLAT = 0.02;

/// Cosine of the highest horizon on one side of the slice.
float horizon(vec2 origin, vec2 stride, vec3 p, vec3 v, vec3 n, float lowest, float jitter) {
    float highest = lowest;
    float inverse_r2 = 1.0 / (push.radius * push.radius);
    for (int i = 0; i < STEPS; ++i) {
        float s = (float(i) + jitter) / float(STEPS);
        vec2 at = origin + stride * (s * s);
        ivec2 pixel = ivec2(at);
        if (pixel == ivec2(origin)) pixel = ivec2(origin + normalize(stride) * 1.5);
        if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, full_size))) break;
        float d = texelFetch(depth, pixel, 0).r;
        if (d <= 0.0) continue;
        vec3 delta = position_at(pixel, d) - p;
        float r2 = dot(delta, delta);
        float inverse_r = inversesqrt(max(r2, 1e-12));
        if (dot(delta, n) * inverse_r < FLAT) continue;
        float c = dot(delta, v) * inverse_r;
        // Beyond the radius nothing occludes; the last fifth fades, so that no ring shows.
        float w = clamp((1.0 - r2 * inverse_r2) * 2.5, 0.0, 1.0);
        highest = max(highest, mix(lowest, c, w));
    }
    return highest;
}

void main() {
    full_size = textureSize(depth, 0);
    ivec2 pixel = min(ivec2(gl_FragCoord.xy) * DOWNSCALE, full_size - 1);
    float d = texelFetch(depth, pixel, 0).r;
    if (d <= 0.0) {
        occlusion = vec2(1.0, 0.0);
        return;
    }
    vec3 p = position_at(pixel, d);
    vec3 v = normalize(-p);
    vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg) * view.world_from_view;
    // 4x4 pattern of directions and step offsets (Jimenez et al.), taken out again by the 4x4 blur.
    ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
    float turn = fract(float(((cell.x + cell.y) & 3) * 4 + cell.x) / 16.0 + push.phase);
    float jitter = fract(float((cell.y - cell.x) & 3) * 0.25 + 0.125 + push.phase * 7.0);
    // Slices turn evenly about v, which leaves the image plane's normal toward the picture's edges.
    vec3 right = normalize(vec3(v.z, 0.0, -v.x));
    vec3 up = cross(v, right);
    vec2 pixels_at_distance = 0.5 * vec2(full_size) * push.radius / (-p.z * view.ray_scale);
    vec2 origin = vec2(pixel) + 0.5;
    float blocked = 0.0;
    for (int slice = 0; slice < SLICES; ++slice) {
        float phi = (float(slice) + turn) * (PI / float(SLICES));
        vec3 direction = right * cos(phi) + up * sin(phi);
        vec3 axis = normalize(cross(direction, v));
        vec3 projected = n - axis * dot(n, axis);
        float length_n = max(length(projected), 1e-4);
        float cos_n = clamp(dot(projected, v) / length_n, -1.0, 1.0);
        float angle_n = (dot(direction, projected) >= 0.0 ? 1.0 : -1.0) * fast_acos(cos_n);
        // The perspective image of a step of the radius along the direction.
        vec2 stride = (direction.xy - direction.z * p.xy / p.z) * pixels_at_distance;
        float sin_n = sin(angle_n);
        // The tangent plane bounds both horizons from below.
        float low_minus = cos(angle_n - PI * 0.5);
        float low_plus = cos(angle_n + PI * 0.5);
        float minus = -fast_acos(horizon(origin, -stride, p, v, n, low_minus, jitter));
        float plus = fast_acos(horizon(origin, stride, p, v, n, low_plus, jitter));
        minus = angle_n + max(minus - angle_n, -PI * 0.5);
        plus = angle_n + min(plus - angle_n, PI * 0.5);
        float arcs = (cos_n + 2.0 * minus * sin_n - cos(2.0 * minus - angle_n))
                   + (cos_n + 2.0 * plus * sin_n - cos(2.0 * plus - angle_n));
        // Less the same slice of an open plane, whose mean over all slices is 1.
        blocked += length_n * (cos_n + angle_n * sin_n - 0.25 * arcs);
    }
    // Not cut at 0: a single slice may block more than its share, and only the mean over many is A.
    occlusion = vec2(1.0 - blocked / float(SLICES), -p.z);
}
