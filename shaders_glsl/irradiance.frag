#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "constants.glsl"
#include "cube.glsl"
#include "frame.glsl"
#include "random.glsl"

// The lecture's slide "Integrating skylight": E(n) = 1/N sum L (n.w) / pdf(w) with pdf = (n.w) / pi, so each sample adds pi L.

layout(location = 0) in vec2 face_st;
layout(location = 1) flat in int face;
layout(location = 0) out vec4 sum;            // rgb: sum of pi L, klx; a: number of samples
layout(location = 1) out vec4 sky_irradiance; // E, klx

layout(constant_id = 0) const bool MONTE_CARLO = false;

layout(set = 0, binding = 0) uniform samplerCube sky_radiance; // kcd/m^2
layout(set = 0, binding = 1) uniform samplerCube previous_sum;
layout(set = 0, binding = 2, scalar) readonly buffer Samples {
    vec4 samples[]; // xyz: cosine-weighted directions around +z, low-discrepancy; w: mip level of the lookup
};

layout(push_constant, scalar) uniform Push {
    uint first; // index of the first sample of this pass; 0 starts anew
    uint count; // samples of this pass
} push;

vec3 random_direction(inout uint t) {
    float xi1 = rnd(t);
    float xi2 = rnd(t);
    float sin_theta = sqrt(xi1);
    float phi = 2.0 * PI * xi2;
    return vec3(cos(phi) * sin_theta, sin(phi) * sin_theta, sqrt(1.0 - xi1));
}

/// The frame turned around its normal, by angles that fill the circle evenly among neighbouring texels (the R2 sequence of
/// Roberts 2018): their errors differ, and the bilinear lookup of the map averages them.
mat3 turned(mat3 frame, vec2 texel, int face) {
    float angle = 2.0 * PI * fract(dot(texel, vec2(0.7548776662, 0.5698402910)) + 0.6180339887 * float(face));
    vec2 turn = vec2(cos(angle), sin(angle));
    return mat3(turn.x * frame[0] + turn.y * frame[1], turn.x * frame[1] - turn.y * frame[0], frame[2]);
}

void main() {
    vec3 n = normalize(cube_direction(face, face_st));
    mat3 frame = frame_from_normal(n);
    if (!MONTE_CARLO) frame = turned(frame, floor(gl_FragCoord.xy), face);
    uint edge = uint(textureSize(previous_sum, 0).x);
    uint texel = uint(gl_FragCoord.y) * edge + uint(gl_FragCoord.x);
    uint t = tea(texel, uint(face) + 6u * push.first);
    vec3 total = vec3(0.0);
    for (uint i = 0u; i < push.count; ++i) {
        // Filtered importance sampling (Krivanek and Colbert 2008): a sample stands for its share of the hemisphere. The
        // lecture's random samples look at points.
        vec4 local = MONTE_CARLO ? vec4(random_direction(t), 0.0) : samples[push.first + i];
        total += textureLod(sky_radiance, frame * local.xyz, local.w).rgb;
    }
    sum = vec4(PI * total, float(push.count));
    if (push.first > 0u) sum += textureLod(previous_sum, n, 0.0);
    sky_irradiance = vec4(sum.rgb / sum.a, 1.0);
}
