#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "ssao.glsl"

layout(location = 0) out uint occlusion; // A and the distance along the view axis, packed;

void main() {
    // The depth test passes only points with a surface.
    occlusion = slice_at(ivec2(gl_FragCoord.xy));
}
