#version 460
#extension GL_GOOGLE_include_directive : require
#include "texel.glsl"

// Depth at the occlusion's points, so that the depth test rejects the sky: on a software device an early return saves nothing.

layout(constant_id = 0) const int PIXELS_PER_POINT = 1; // along each axis

layout(set = 0, binding = 0) uniform sampler2D depth;

void main() {
    vec2 pixel = floor(gl_FragCoord.xy) * float(PIXELS_PER_POINT);
    gl_FragDepth = texel_at(depth, pixel).r;
}
