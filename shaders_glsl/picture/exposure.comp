#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "colour.glsl"

// Metering for automatic exposure: the log-average luminance (Reinhard et al. 2002, eq. 1), bounded around the median. The CPU
// counterpart is daylight/exposure.rs. One workgroup computes a histogram, its median, then the bounded mean of log2 L.

// Every device has room for so many in a workgroup.
const uint THREADS = 128u;
layout(local_size_x = 128) in;

const uint BINS = 256u;

layout(set = 0, binding = 0) uniform sampler2D radiance;                       // kcd/m^2
layout(set = 0, binding = 1) uniform sampler2D previous_luminance;             // kcd/m^2, one texel
layout(set = 0, binding = 2, rgba32f) uniform writeonly image2DArray average_luminance; // one texel; r: kcd/m^2; g: over the previous one

layout(push_constant, scalar) uniform Push {
    float black;         // log2 of kcd/m^2: darker samples are ignored
    float bins_per_stop; // of the histogram, which starts at `black`
    float bound;         // largest distance of a sample from the median, stops
    float fade;          // stops beyond that, toward black, over which its weight falls to 0
    float share;         // blend from the previous luminance (0) to that of this picture (1); 1 if there is no previous one
} push;

// Samples on a grid over the picture: enough for a mean, at a cost independent of the resolution.
const uvec2 GRID = uvec2(128u, 72u);
const uint SAMPLES = GRID.x * GRID.y / THREADS; // per thread

shared uint bins[BINS];
shared float median; // log2 of kcd/m^2
shared vec2 sums[THREADS]; // weighted distance from the median, weight

const float NOTHING = -1e4;

/// log2 of the luminance at a sample, kcd/m^2; NOTHING for black and NaN.
float log_luminance(uint index) {
    vec2 size = vec2(textureSize(radiance, 0));
    vec2 at = (vec2(index % GRID.x, index / GRID.x) + 0.5) / vec2(GRID) * size;
    float l = luminance(texelFetch(radiance, ivec2(min(at, size - 1.0)), 0).rgb);
    return l >= exp2(push.black) ? log2(min(l, 1e30)) : NOTHING;
}

/// The median from the histogram, linear within a bin; NOTHING if the histogram is empty.
float find_median() {
    uint count = 0u;
    for (uint i = 0u; i < BINS; ++i) count += bins[i];
    float middle = 0.5 * float(count);
    uint below = 0u;
    for (uint i = 0u; i < BINS; ++i) {
        if (bins[i] > 0u && float(below + bins[i]) >= middle) {
            float within = (middle - float(below)) / float(bins[i]);
            return push.black + (float(i) + within) / push.bins_per_stop;
        }
        below += bins[i];
    }
    return NOTHING;
}

void main() {
    uint thread = gl_LocalInvocationIndex;
    for (uint i = thread; i < BINS; i += THREADS) bins[i] = 0u;
    barrier();
    float logs[SAMPLES];
    for (uint i = 0u; i < SAMPLES; ++i) {
        logs[i] = log_luminance(thread + i * THREADS);
        if (logs[i] > NOTHING) {
            float bin = (logs[i] - push.black) * push.bins_per_stop;
            atomicAdd(bins[uint(clamp(bin, 0.0, float(BINS - 1u)))], 1u);
        }
    }
    barrier();
    if (thread == 0u) median = find_median();
    barrier();
    vec2 sum = vec2(0.0);
    for (uint i = 0u; i < SAMPLES; ++i) {
        float distance = logs[i] - median;
        float weight = clamp((distance + push.bound) / push.fade + 1.0, 0.0, 1.0);
        sum += vec2(clamp(distance, -push.bound, push.bound), 1.0) * weight;
    }
    sums[thread] = sum;
    barrier();
    if (thread != 0u) return;
    for (uint i = 1u; i < THREADS; ++i) sum += sums[i];
    bool black = median == NOTHING;
    // A black picture looks the same at any exposure.
    float target = black ? 0.0 : median + sum.x / sum.y;
    float previous = log2(texelFetch(previous_luminance, ivec2(0), 0).r);
    if (push.share < 1.0) target = black ? previous : mix(previous, target, push.share);
    imageStore(average_luminance, ivec3(0), vec4(exp2(target), exp2(target - previous), 0.0, 0.0));
}
