#include "occlusion.glsl"
#include "texel.glsl"

// Removes the noise pattern of ssao.glsl with an edge-aware box filter as wide as the pattern, four texels.

layout(constant_id = 1) const int DOWNSCALE = 1; // pixels of the G-buffer per occluder, along each axis
layout(constant_id = 2) const int SPACING = 1;   // occluders per texel, along each axis

// A depth edge is a change of distance by more than this fraction of it ..
const float EDGE = 0.01;
// .. plus this many times the slope of the plane at the texel: across the box, the plane changes by two texels of slope.
const float PLANE = 3.0;

layout(set = 0, binding = 0) uniform usampler2D noisy_occlusion;
layout(set = 0, binding = 1) uniform sampler2D depth;

layout(push_constant, scalar) uniform Push {
    float near; // metres
} push;

float distance_at(vec2 texel) {
    return distance_of_depth(texel_at(depth, texel * float(DOWNSCALE)).r, push.near);
}

/// Whether a point has a surface.
bool is_surface_at(vec2 at) {
    return texel_at(depth, floor(at) * float(SPACING * DOWNSCALE)).r > 0.0;
}

/// A and the distance along the view axis, packed; `at`: centre of the texel.
uint smooth_at(vec2 at) {
    vec2 texel = floor(at) * float(SPACING);
    float centre = distance_at(texel);
    // A plane seen at a grazing angle is not an edge: the tolerance follows the smaller step to a neighbour.
    float slope = min(abs(distance_at(texel - vec2(1, 0)) - centre), abs(distance_at(texel + vec2(1, 0)) - centre))
                + min(abs(distance_at(texel - vec2(0, 1)) - centre), abs(distance_at(texel + vec2(0, 1)) - centre));
    float scale = 1.0 / (EDGE * centre + PLANE * slope * float(SPACING) + 1e-6);
    vec2 size = vec2(textureSize(noisy_occlusion, 0));
    vec2 sum = vec2(0.0);
    for (int y = -2; y <= 2; ++y) {
        for (int x = -2; x <= 2; ++x) {
            vec2 tap = occlusion_unpack(textureLod(noisy_occlusion, (at + vec2(x, y)) / size, 0.0).r);
            // Five texels with half weight on the outer ones are as wide as four, and centred.
            float inside = (abs(x) == 2 ? 0.5 : 1.0) * (abs(y) == 2 ? 0.5 : 1.0);
            float step = abs(tap.y - centre) * scale;
            // The lower limit gives a mean even if all texels lie beyond an edge.
            sum += vec2(tap.x, 1.0) * (inside * max(1.0 - step, 1e-4));
        }
    }
    return occlusion_pack(clamp(sum.x / sum.y, 0.0, 1.0), centre);
}
