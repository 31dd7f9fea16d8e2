#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "occluder.glsl"

// Takes out the 4x4 pattern of ssao.frag by a box of its size that does not cross depth edges.

layout(location = 0) out uint occlusion; // A and the distance along the view axis, packed

layout(set = 0, binding = 0) uniform usampler2D noisy_occlusion;

ivec2 last;

vec2 tap(ivec2 texel) {
    return occlusion_unpack(texelFetch(noisy_occlusion, clamp(texel, ivec2(0), last), 0).r);
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    last = textureSize(noisy_occlusion, 0) - 1;
    vec2 taps[16];
    for (int i = 0; i < 16; ++i) taps[i] = tap(texel + ivec2(i & 3, i >> 2) - 2);
    // The slope of a plane seen at a grazing angle is no edge: the tolerance follows the smaller neighbouring step.
    float centre = taps[10].y;
    float slope = min(abs(taps[9].y - centre), abs(taps[11].y - centre))
                + min(abs(taps[6].y - centre), abs(taps[14].y - centre));
    float scale = 1.0 / (0.01 * centre + 3.0 * slope + 1e-6);
    vec2 sum = vec2(0.0);
    for (int i = 0; i < 16; ++i) {
        float w = max(1.0 - abs(taps[i].y - centre) * scale, 0.0);
        sum += vec2(taps[i].x, 1.0) * w;
    }
    // The texel itself always counts (w = 1), so the sum of weights is at least one.
    occlusion = occlusion_pack(clamp(sum.x / sum.y, 0.0, 1.0), centre);
}
