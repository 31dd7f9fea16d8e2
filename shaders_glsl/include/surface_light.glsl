// The surface that a ray hits, and the light of the sun there. Needs `scene` (see scene_light.glsl).
#include "surface_hit.glsl"

/// Irradiance of the sun at a point, klx, for a point xi in [0, 1)^2 of its disc.
vec3 sun_irradiance_at(vec3 position, vec3 normal, vec2 xi) {
    float radius = scene.sun_tan_radius * sqrt(xi.x), phi = 2.0 * PI * xi.y;
    vec3 toward = normalize(frame_from_normal(scene.sun_direction) * vec3(radius * cos(phi), radius * sin(phi), 1.0));
    vec3 light = scene.sun_illuminance * max(dot(normal, toward), 0.0);
    // Of the product: lavapipe compiles a shader anew for the values of uniforms that alone decide a branch, here for every new sun.
    if (light == vec3(0.0) || toward.y <= 0.0 || any_hit(position, toward, FAR)) return vec3(0.0);
    return light;
}
