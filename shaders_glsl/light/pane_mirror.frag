#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "constants.glsl"
#include "filtered.glsl"
#include "pane.glsl"
#include "surface_hit.glsl"

// What a pane of glass mirrors: the sky, or surfaces in the light of the sun and of the sky as if nothing hid it. The sums of all panes
// are taken.

layout(location = 0) in vec3 from_eye;
layout(location = 1) in vec3 shading_normal;

layout(location = 0) out vec4 mirrored; // kcd/m^2

layout(set = 0, binding = 1) uniform samplerCube sky_radiance;   // L of sky and ground, kcd/m^2, without the disc
layout(set = 0, binding = 2) uniform samplerCube sky_irradiance; // E of sky and ground, klx
layout(set = 0, binding = 3, scalar) uniform Sun {
    vec3 direction;   // unit, toward the sun
    vec3 illuminance; // at normal incidence, klx
} sun;

/// Radiance of what a ray meets, kcd/m^2.
vec3 seen(vec3 origin, vec3 toward) {
    Hit hit = traced(origin, toward, FAR, false, PANES_ARE_OPEN);
    if (hit.distance == FAR) return filtered(sky_radiance, toward, 0.0).rgb;
    Surface surface = surface_of(hit, origin, toward);
    vec3 irradiance = filtered(sky_irradiance, surface.normal, 0.0).rgb;
    float cosine = dot(surface.normal, sun.direction);
    bool is_lit = cosine > 0.0 && sun.illuminance != vec3(0.0) && traced(surface.position, sun.direction, FAR, true, PANES_ARE_OPEN).distance == FAR;
    if (is_lit) irradiance += cosine * sun.illuminance;
    return surface.albedo / PI * irradiance + surface.emission;
}

void main() {
    vec3 toward = normalize(from_eye), n = normalize(shading_normal);
    if (dot(n, toward) > 0.0) n = -n;
    vec3 reflectance = pane_reflectance(push.internal, glass_surface(dot(n, toward)));
    vec3 r = reflect(toward, n);
    mirrored = vec4(push.scale * reflectance * seen(lifted(camera.eye + from_eye, n), r), 0.0);
}
