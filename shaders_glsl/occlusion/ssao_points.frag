#version 460
#extension GL_GOOGLE_include_directive : require
#include "occluder.glsl"

// Depth at the points of the occlusion, so that the depth test leaves out the sky: a shader that returns early saves a software
// device nothing.

layout(constant_id = 0) const int DOWNSCALE = 2;

layout(set = 0, binding = 0) uniform sampler2D depth;

void main() {
    vec2 pixel = floor(gl_FragCoord.xy) * float(DOWNSCALE * OCCLUSION_SPACING);
    gl_FragDepth = textureLod(depth, (pixel + 0.5) / vec2(textureSize(depth, 0)), 0.0).r;
}
