// The grey skies of daylight::grey_sky: the standard skies of the CIE and the measured sky of Perez.
#include "sky.glsl"

layout(set = 0, binding = 0, scalar) uniform Model {
    float gradation[3];  // a, b, g of 1 + a e^(b / cos Z) + g cos Z
    float indicatrix[4]; // k, c, d, e of k + c e^(d chi) + e cos^2 chi
    float least_cosine;  // for cos Z in b / cos Z
    float level;         // luminance where the product is 1, kcd/m^2
} model;

float grey(vec3 direction) {
    float cos_theta = max(direction.y, model.least_cosine);
    float chi = angle_between(direction, push.sun_direction);
    float cos_chi = dot(direction, push.sun_direction);
    float gradation = 1.0 + model.gradation[0] * exp(model.gradation[1] / cos_theta) + model.gradation[2] * max(direction.y, 0.0);
    float indicatrix = model.indicatrix[0] + model.indicatrix[1] * exp(model.indicatrix[2] * chi)
                     + model.indicatrix[3] * cos_chi * cos_chi;
    return model.level * max(gradation * indicatrix, 0.0);
}

/// Radiance of the sky in a unit direction, kcd/m^2.
vec4 sky(vec3 direction) {
    return guarded(direction, vec3(grey(direction)));
}
