#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "ssao_blur.glsl"

layout(location = 0) out uint occlusion; // A and the distance along the view axis, packed;

void main() {
    // The depth test passes only points with a surface.
    occlusion = smooth_at(gl_FragCoord.xy);
}
