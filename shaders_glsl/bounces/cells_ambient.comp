#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "fullscreen_compute.glsl"
#include "cells_ambient.glsl"

layout(set = 0, binding = 40, rgba32ui) uniform writeonly uimage2DArray ambient; // see half_size.glsl

void main() {
    if (!is_pixel_of(imageSize(ambient).xy)) return;
    imageStore(ambient, own_texel(), ambient_at(pixel_centre()));
}
