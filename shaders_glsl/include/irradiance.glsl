// As on the lecture's slide "Integrating skylight": E(n) = 1/N sum L (n.w) / pdf(w) with pdf = (n.w) / pi; a sample adds pi L.
#include "constants.glsl"
#include "filtered.glsl"
#include "frame.glsl"
#include "random.glsl"

layout(constant_id = 0) const bool MONTE_CARLO = false;

layout(set = 0, binding = 0) uniform samplerCube sky_radiance; // kcd/m^2
layout(set = 0, binding = 1) uniform samplerCube previous_sum;
layout(set = 0, binding = 2, scalar) readonly buffer Samples {
    vec4 samples[]; // xyz: cosine-weighted directions around +z, low-discrepancy; w: mip level of the lookup
};

layout(push_constant, scalar) uniform Push {
    uint first; // index of the first sample of this pass; 0 restarts
    uint count; // samples of this pass
} push;

vec3 random_direction(inout uint t) {
    float xi1 = rnd(t);
    float xi2 = rnd(t);
    float sin_theta = sqrt(xi1);
    float phi = 2.0 * PI * xi2;
    return vec3(cos(phi) * sin_theta, sin(phi) * sin_theta, sqrt(1.0 - xi1));
}

/// The frame rotated about its normal by an angle that varies evenly among neighbouring texels (R2 sequence, Roberts 2018): their
/// errors differ, and the map's bilinear lookup averages them.
mat3 turned(mat3 frame, ivec2 texel, int face) {
    float angle = 2.0 * PI * fract(dot(vec2(texel), vec2(0.7548776662, 0.5698402910)) + 0.6180339887 * float(face));
    vec2 turn = vec2(cos(angle), sin(angle));
    return mat3(turn.x * frame[0] + turn.y * frame[1], turn.x * frame[1] - turn.y * frame[0], frame[2]);
}

/// The sum so far including this pass's samples; rgb: pi L, klx; a: number of samples. `n` is the texel's direction.
vec4 refined(vec3 n, ivec2 texel, int face) {
    mat3 frame = frame_from_normal(n);
    if (!MONTE_CARLO) frame = turned(frame, texel, face);
    uint edge = uint(textureSize(previous_sum, 0).x);
    uint t = tea(uint(texel.y) * edge + uint(texel.x), uint(face) + 6u * push.first);
    vec3 total = vec3(0.0);
    for (uint i = 0u; i < push.count; ++i) {
        // Filtered importance sampling (Krivanek and Colbert 2008): a sample represents its part of the hemisphere. The
        // lecture's random samples are unfiltered.
        vec4 local = MONTE_CARLO ? vec4(random_direction(t), 0.0) : samples[push.first + i];
        total += filtered(sky_radiance, frame * local.xyz, local.w).rgb;
    }
    vec4 sum = vec4(PI * total, float(push.count));
    if (push.first > 0u) sum += textureLod(previous_sum, n, 0.0);
    return sum;
}

/// E, klx, from a sum.
vec4 mean(vec4 sum) {
    return vec4(sum.rgb / sum.a, 1.0);
}
