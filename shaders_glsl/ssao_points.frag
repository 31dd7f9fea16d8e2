#version 460
#extension GL_GOOGLE_include_directive : require
#include "occluder.glsl"

// Depth at the points of the occlusion, so that the depth test leaves out the sky: a shader that returns early saves a software
// device nothing.

layout(constant_id = 0) const int DOWNSCALE = 2;

layout(set = 0, binding = 0) uniform sampler2D depth;

void main() {
    gl_FragDepth = texelFetch(depth, ivec2(gl_FragCoord.xy) * (DOWNSCALE * OCCLUSION_SPACING), 0).r;
}
