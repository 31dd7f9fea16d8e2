// CIE standard overcast sky (Moon and Spencer 1942): L = L_z (1 + 2 sin el) / 3.
#include "sky.glsl"

layout(set = 0, binding = 0, scalar) uniform Model {
    float zenith_luminance; // kcd/m^2
} model;

/// Radiance of the sky in a unit direction, kcd/m^2.
vec4 sky(vec3 direction) {
    return guarded(direction, vec3(model.zenith_luminance * (1.0 + 2.0 * max(direction.y, 0.0)) / 3.0));
}
