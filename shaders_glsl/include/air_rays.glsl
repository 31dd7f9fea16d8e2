#ifndef AIR_RAYS_GLSL
#define AIR_RAYS_GLSL
#include "constants.glsl"
// The rays of an eye in the air, as daylight::atmosphere::aerial has them on the CPU. Lengths in km.

struct Rays {
    float altitude; // of the eye
    float ceiling;  // where rays above the horizon end
    float horizon;  // sine of its elevation
    float ground_radius;
};

/// Length of the ray whose elevation has this sine: to the ground or to the ceiling.
float ray_length(Rays rays, float sine, bool meets_ground) {
    float along = (rays.ground_radius + rays.altitude) * sine;
    float height = meets_ground ? rays.altitude * (2.0 * rays.ground_radius + rays.altitude)
                                : (rays.ceiling - rays.altitude) * (2.0 * rays.ground_radius + rays.altitude + rays.ceiling);
    if (meets_ground) {
        float less = sqrt(max(along * along - height, 0.0)) - along;
        return less > 0.0 ? height / less : 0.0;
    }
    float root = sqrt(height + along * along);
    return along > 0.0 ? height / (root + along) : root - along;
}

/// Share of the light that an aerosol scatters per sr, at the cosine of the scattering angle.
float henyey_greenstein(float g, float cosine) {
    float root = inversesqrt(1.0 + g * g - 2.0 * g * cosine);
    return (1.0 - g * g) / (4.0 * PI) * (root * root * root);
}
#endif
