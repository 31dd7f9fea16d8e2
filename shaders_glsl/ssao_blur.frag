#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "occluder.glsl"

// Takes out the pattern of ssao.frag by a box of 4x4 of its texels that does not cross depth edges; fills in those that a sparse
// target leaves out.

layout(location = 0) out uint occlusion; // A and the distance along the view axis, packed

layout(constant_id = 0) const bool SPARSE = true; // as of ssao.frag

layout(set = 0, binding = 0) uniform usampler2D noisy_occlusion;
layout(set = 0, binding = 1) uniform usampler2D occluders;

const int TAPS = 4; // of a row

float distance_at(ivec2 texel) {
    ivec2 last = textureSize(occluders, 0) - 1;
    return packed_distance(texelFetch(occluders, clamp(texel, ivec2(0), last), 0).r);
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    float centre = distance_at(texel);
    if (centre >= 0.5 * NOWHERE) {
        occlusion = occlusion_pack(1.0, 0.0);
        return;
    }
    // The slope of a plane seen at a grazing angle is no edge: the tolerance follows the smaller neighbouring step.
    float slope = min(abs(distance_at(texel - ivec2(1, 0)) - centre), abs(distance_at(texel + ivec2(1, 0)) - centre))
                + min(abs(distance_at(texel - ivec2(0, 1)) - centre), abs(distance_at(texel + ivec2(0, 1)) - centre));
    float scale = 1.0 / (0.01 * centre + 3.0 * slope + 1e-6);
    ivec2 last = textureSize(noisy_occlusion, 0) - 1;
    vec2 sum = vec2(0.0);
    for (int row = 0; row < 4; ++row) {
        int y = clamp(texel.y + row - 2, 0, last.y);
        // Of a sparse row the second is the first that is not left of a box of 4x4 occluders.
        int first = SPARSE ? ((texel.x - 1 - (y & 1)) >> 1) - 1 : texel.x - 2;
        for (int i = 0; i < TAPS; ++i) {
            vec2 tap = occlusion_unpack(texelFetch(noisy_occlusion, ivec2(clamp(first + i, 0, last.x), y), 0).r);
            float step = abs(tap.y - centre) * scale;
            // Where all lie beyond an edge their mean is better than nothing.
            sum += vec2(tap.x, 1.0) * max(1.0 - step, 1e-4);
        }
    }
    occlusion = occlusion_pack(clamp(sum.x / sum.y, 0.0, 1.0), centre);
}
