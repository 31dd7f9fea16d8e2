// Hosek and Wilkie 2012, eq. 8, with the published RGB fit.
#include "sky.glsl"

layout(set = 0, binding = 0, scalar) uniform Model {
    float coefficients[27]; // nine of R, of G, of B in the authors' order A B C D E F G I H
    vec3 mean_radiance;     // kcd/m^2
} model;

float distribution(int channel, float cos_theta, float gamma) {
    int k = 9 * channel;
    float h = model.coefficients[k + 8];
    float cos_gamma = cos(gamma);
    float chi = (1.0 + cos_gamma * cos_gamma) / pow(1.0 + h * h - 2.0 * h * cos_gamma, 1.5);
    return (1.0 + model.coefficients[k] * exp(model.coefficients[k + 1] / (cos_theta + 0.01)))
         * (model.coefficients[k + 2] + model.coefficients[k + 3] * exp(model.coefficients[k + 4] * gamma)
            + model.coefficients[k + 5] * cos_gamma * cos_gamma + model.coefficients[k + 6] * chi
            + model.coefficients[k + 7] * sqrt(cos_theta));
}

/// Radiance of the sky in a unit direction, kcd/m^2.
vec4 sky(vec3 direction) {
    float cos_theta = max(direction.y, 0.0);
    float gamma = angle_between(direction, push.sun_direction);
    vec3 f = vec3(distribution(0, cos_theta, gamma), distribution(1, cos_theta, gamma), distribution(2, cos_theta, gamma));
    return guarded(direction, model.mean_radiance * f);
}
