#include "filtered.glsl"
#include "panes.glsl"
#include "view.glsl"

// The background, as on the lecture's slide "Environment mapping - filling the background": the sky cube along the pixel's ray.
// It is for pixels without a surface. The discs of sun and moon are drawn only here.

layout(constant_id = 0) const bool SKY = true;
// Whether a disc may be in view.
layout(constant_id = 2) const bool DISC = true;
// Constant for pixels without a surface, if the sky is not drawn.
layout(constant_id = 1) const float EMPTY = 0.0;

// What panes of glass mirror is shown.
layout(constant_id = 3) const bool MIRRORED = false;

layout(set = 0, binding = 0) uniform samplerCube sky_radiance; // kcd/m^2, without the discs
layout(set = 0, binding = 1, scalar) uniform View { VIEW_BLOCK } view;

layout(push_constant, scalar) uniform Push {
    vec2 size;          // pixels
    vec3 direction;     // unit, toward the sun
    vec3 luminance;     // of the disc's centre, kcd/m^2
    float sin_radius;   // of the disc
    float limb;         // limb darkening coefficient u; 0: a uniform disc
    float max_radiance; // largest value the target can represent, kcd/m^2
    vec3 moon;          // unit, toward the moon
    float moon_sin_radius;
    vec3 moon_luminance; // of the full disc, kcd/m^2
    vec3 moon_sunward;  // unit, from the moon toward the sun
} push;

/// Luminance of the disc with limb darkening: I = I0 (1 - u (1 - mu)).
vec3 disc(vec3 direction) {
    // By the sine: in float32, cosines of a quarter of a degree have no precision left.
    float s = length(cross(direction, push.direction)) / push.sin_radius;
    float mu = sqrt(max(1.0 - s * s, 0.0));
    bool inside = s < 1.0 && dot(direction, push.direction) > 0.0;
    return inside ? push.luminance * (1.0 - push.limb * (1.0 - mu)) : vec3(0.0);
}

/// Luminance of the moon's disc: Lommel and Seeliger's law on a sphere, as in `daylight::moon`.
vec3 moon(vec3 direction) {
    // By the vector across: in float32 the difference of two cosines has no precision left.
    vec3 across = cross(cross(push.moon, direction), push.moon) / push.moon_sin_radius;
    float beside = dot(across, across);
    if (beside >= 1.0 || dot(direction, push.moon) <= 0.0) return vec3(0.0);
    float to_eye = sqrt(1.0 - beside);
    float to_sun = max(dot(across - push.moon * to_eye, push.moon_sunward), 0.0);
    return push.moon_luminance * (2.0 * to_sun / max(to_sun + to_eye, 1e-6));
}

/// The background of a pixel; `at`: its centre. rgb: kcd/m^2, or a constant; a: illuminance, 0 without a surface.
vec4 behind(vec2 at) {
    ivec2 pixel = ivec2(at);
    vec3 mirrored = MIRRORED ? mirrored_by_panes(pixel) : vec3(0.0);
    if (!SKY) return vec4(vec3(EMPTY) + mirrored, 0.0);
    vec3 ray = view_ray(at / push.size, view.ray_scale, view.ray_offset);
    vec3 direction = view.world_from_view * ray;
    vec3 sky = filtered(sky_radiance, direction, 0.0).rgb;
    if (DISC) sky += disc(normalize(direction)) + moon(normalize(direction));
    return vec4(min(sky * through_panes(pixel) + mirrored, push.max_radiance), 0.0);
}
