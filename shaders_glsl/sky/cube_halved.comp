#version 460
#extension GL_GOOGLE_include_directive : require
#include "cube_halved.glsl"
#include "cube_compute.glsl"

layout(set = 0, binding = 1, rgba32f) uniform writeonly image2DArray coarser;

void main() {
    ivec3 texel = cube_texel();
    if (is_texel_of(imageSize(coarser).xy)) imageStore(coarser, texel, halved(texel.z, texel.xy));
}
