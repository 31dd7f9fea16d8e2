#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "colour.glsl"

// Reinhard et al. 2002, eq. 1: the log-average luminance, in two steps. Here: the mean of log2 L over one tile.

layout(location = 0) out float log_luminance; // log2 of kcd/m^2

layout(set = 0, binding = 0) uniform sampler2D radiance;

layout(push_constant, scalar) uniform Push {
    ivec2 tiles; // size of the target
} push;

// Four samples a way are plenty for a mean, and cost the same at any resolution.
const int SAMPLES = 4;
// Black pixels must not pull the mean to minus infinity: 1e-6 kcd/m^2 is starlight.
const float FLOOR = 1e-6;

void main() {
    vec2 size = vec2(textureSize(radiance, 0));
    vec2 tile = size / vec2(push.tiles);
    vec2 corner = floor(gl_FragCoord.xy) * tile;
    float sum = 0.0;
    for (int y = 0; y < SAMPLES; ++y) {
        for (int x = 0; x < SAMPLES; ++x) {
            vec2 at = corner + tile * (vec2(x, y) + 0.5) / float(SAMPLES);
            float l = luminance(texelFetch(radiance, ivec2(min(at, size - 1.0)), 0).rgb);
            sum += log2(max(l, FLOOR));
        }
    }
    log_luminance = sum / float(SAMPLES * SAMPLES);
}
