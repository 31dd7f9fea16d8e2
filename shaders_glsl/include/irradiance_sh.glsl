// Ramamoorthi and Hanrahan 2001, eq. 10: E(n) = sum A_l L_lm Y_lm(n) up to order 2, A = pi, 2 pi / 3, pi / 4.
#include "constants.glsl"
#include "cube.glsl"

layout(push_constant, scalar) uniform Push {
    vec3 coefficients[9]; // L_lm, kcd/m^2, in the order (0,0) (1,-1) (1,0) (1,1) (2,-2) .. (2,2)
} push;

/// E, klx; a: 1.
vec4 evaluated(vec3 n) {
    float basis[9] = float[](
        0.282094791773878,
        0.488602511902920 * n.y, 0.488602511902920 * n.z, 0.488602511902920 * n.x,
        1.092548430592079 * n.x * n.y, 1.092548430592079 * n.y * n.z,
        0.315391565252520 * (3.0 * n.z * n.z - 1.0),
        1.092548430592079 * n.x * n.z, 0.546274215296040 * (n.x * n.x - n.y * n.y));
    vec3 e = PI * basis[0] * push.coefficients[0];
    for (int i = 1; i < 4; ++i) e += (2.0 * PI / 3.0) * basis[i] * push.coefficients[i];
    for (int i = 4; i < 9; ++i) e += (PI / 4.0) * basis[i] * push.coefficients[i];
    // The truncated series becomes negative for normals facing away from the light.
    return vec4(max(e, 0.0), 1.0);
}
