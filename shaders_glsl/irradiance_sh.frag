#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "constants.glsl"
#include "cube.glsl"

// Ramamoorthi and Hanrahan 2001, eq. 10: E(n) = sum A_l L_lm Y_lm(n) up to order 2, A = pi, 2 pi / 3, pi / 4.

layout(location = 0) in vec2 face_st;
layout(location = 1) flat in int face;
layout(location = 0) out vec4 sum;            // E, klx; a: 1
layout(location = 1) out vec4 sky_irradiance; // E, klx

layout(push_constant, scalar) uniform Push {
    vec3 coefficients[9]; // L_lm, kcd/m^2, in the order (0,0) (1,-1) (1,0) (1,1) (2,-2) .. (2,2)
} push;

void main() {
    vec3 n = normalize(cube_direction(face, face_st));
    float basis[9] = float[](
        0.282094791773878,
        0.488602511902920 * n.y, 0.488602511902920 * n.z, 0.488602511902920 * n.x,
        1.092548430592079 * n.x * n.y, 1.092548430592079 * n.y * n.z,
        0.315391565252520 * (3.0 * n.z * n.z - 1.0),
        1.092548430592079 * n.x * n.z, 0.546274215296040 * (n.x * n.x - n.y * n.y));
    vec3 e = PI * basis[0] * push.coefficients[0];
    for (int i = 1; i < 4; ++i) e += (2.0 * PI / 3.0) * basis[i] * push.coefficients[i];
    for (int i = 4; i < 9; ++i) e += (PI / 4.0) * basis[i] * push.coefficients[i];
    // The truncated series dips below zero on normals away from the light.
    sum = vec4(max(e, 0.0), 1.0);
    sky_irradiance = sum;
}
