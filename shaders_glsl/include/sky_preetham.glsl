// Preetham et al. 1999, A.2.
#include "sky.glsl"

struct Perez {
    float a, b, c, d, e;
};

layout(set = 0, binding = 0, scalar) uniform Model {
    Perez luminance;      // of Y
    Perez chromaticity_x; // of x
    Perez chromaticity_y; // of y
    vec3 zenith_over_f;   // Y (kcd/m^2), x, y at the zenith, each divided by its F(0, theta_s)
} model;

/// F(theta, gamma) = (1 + A e^(B / cos theta)) (1 + C e^(D gamma) + E cos^2 gamma).
float perez(Perez p, float cos_theta, float gamma, float cos_gamma) {
    return (1.0 + p.a * exp(p.b / cos_theta))
         * (1.0 + p.c * exp(p.d * gamma) + p.e * cos_gamma * cos_gamma);
}

vec3 preetham(vec3 direction) {
    float cos_theta = max(direction.y, MIN_COS_THETA);
    float gamma = angle_between(direction, push.sun_direction);
    float cos_gamma = dot(direction, push.sun_direction);
    float Y = model.zenith_over_f.x * perez(model.luminance, cos_theta, gamma, cos_gamma);
    float x = model.zenith_over_f.y * perez(model.chromaticity_x, cos_theta, gamma, cos_gamma);
    float y = model.zenith_over_f.z * perez(model.chromaticity_y, cos_theta, gamma, cos_gamma);
    return RGB_FROM_XYZ * (vec3(x, y, 1.0 - x - y) * (Y / y));
}

/// Radiance of the sky in a unit direction, kcd/m^2.
vec4 sky(vec3 direction) {
    return guarded(direction, preetham(direction));
}
