#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "sky.glsl"

// CIE standard overcast sky (Moon and Spencer 1942): L = L_z (1 + 2 sin el) / 3.

layout(set = 0, binding = 0, scalar) uniform Model {
    float zenith_luminance; // kcd/m^2
} model;

void main() {
    vec3 direction = normalize(cube_direction(face, face_st));
    WRITE_SKY(direction, vec3(model.zenith_luminance * (1.0 + 2.0 * max(direction.y, 0.0)) / 3.0));
}
