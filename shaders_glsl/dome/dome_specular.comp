#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "fullscreen_compute.glsl"
#include "dome_specular.glsl"

// See dome_specular.glsl.
layout(set = 0, binding = 40, rgba32f) uniform writeonly image2DArray new_reflected;
layout(set = 0, binding = 41, r32f) uniform writeonly image2DArray new_lobe;

void main() {
    if (!is_pixel_of(imageSize(new_lobe).xy)) return;
    reflect_at(pixel_centre());
    imageStore(new_reflected, own_texel(), reflected);
    imageStore(new_lobe, own_texel(), vec4(lobe));
}
