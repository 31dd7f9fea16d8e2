#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// FLOAT: the picture has 32-bit floats.
// Variant: FLOAT
#include "fullscreen_compute.glsl"
#include "lighting.glsl"

layout(set = 0, binding = 40, PICTURE_FORMAT) uniform writeonly image2DArray radiance; // as in lighting.frag

void main() {
    if (!is_pixel_of(imageSize(radiance).xy)) return;
    vec2 at = pixel_centre();
    // Pixels without a surface are kept.
    if (textureLod(depth, at / vec2(textureSize(depth, 0)), 0.0).r == 0.0) return;
    imageStore(radiance, own_texel(), lit(at));
}
