#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "specular.glsl"
#include "cube_compute.glsl"

layout(set = 0, binding = 2, rgba32f) uniform writeonly image2DArray specular_radiance; // kcd/m^2

void main() {
    ivec2 size = imageSize(specular_radiance).xy;
    if (!is_texel_of(size)) return;
    imageStore(specular_radiance, cube_texel(), prefiltered(texel_direction(size)));
}
