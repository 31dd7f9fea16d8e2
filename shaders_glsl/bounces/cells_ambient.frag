#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "cells_ambient.glsl"

layout(location = 0) out uvec4 ambient; // see half_size.glsl

void main() {
    ambient = ambient_at(gl_FragCoord.xy);
}
