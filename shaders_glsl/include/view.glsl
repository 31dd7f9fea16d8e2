#ifndef VIEW_GLSL
#define VIEW_GLSL
// Camera data for the screen-space passes. Depth is reversed with an infinite far plane: d = near / distance.

/// Members of the uniform block of the passes that reconstruct positions.
#define VIEW_BLOCK \
    mat3 world_from_view; \
    vec3 eye; \
    vec2 ray_scale; \
    vec2 ray_offset; \
    float near;

/// View-space ray through a point uv in [0,1]^2 of the picture, with z = -1.
/// This is the inverse projection of the lecture's background slide, written out: only its diagonal matters.
vec3 view_ray(vec2 uv, vec2 ray_scale, vec2 ray_offset) {
    return vec3((uv * 2.0 - 1.0) * ray_scale + ray_offset, -1.0);
}

/// View-space normal, on the viewer's side, of a plane. `slopes`: relative change of reversed depth per unit of the ray's x and y.
vec3 normal_of_slopes(vec2 slopes, vec2 ray) {
    return normalize(vec3(-slopes, 1.0 - dot(slopes, ray)));
}
#endif
