#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "view.glsl"

// Stars as points: each one is a square of 2 x 2 pixels around it. The fragment shader shares its flux among them.

struct Star {
    vec3 direction;   // unit, in world space
    vec3 illuminance; // at normal incidence, klx
};

layout(set = 0, binding = 0, scalar) readonly buffer Stars {
    Star stars[];
} table;
layout(set = 0, binding = 1, scalar) uniform View { VIEW_BLOCK } view;

layout(push_constant, scalar) uniform Push {
    vec2 size; // of the picture, pixels
} push;

layout(location = 0) flat out vec2 place;    // of the star, pixels
layout(location = 1) flat out vec3 radiance; // of one pixel with all of its flux, kcd/m^2

void main() {
    Star star = table.stars[gl_VertexIndex / 6];
    vec3 ray = transpose(view.world_from_view) * star.direction;
    place = vec2(0.0);
    radiance = vec3(0.0);
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0);
    if (ray.z > -1e-3) return; // behind the viewer
    vec2 at = (ray.xy / -ray.z - view.ray_offset) / view.ray_scale;
    if (any(greaterThan(abs(at), vec2(1.5)))) return;
    place = (at * 0.5 + 0.5) * push.size;
    // Of a pixel here: its area on the plane at distance 1 in front of the eye, seen from further away and aslant.
    float solid_angle = abs(4.0 * view.ray_scale.x * view.ray_scale.y / (push.size.x * push.size.y)) * -ray.z * ray.z * ray.z;
    radiance = star.illuminance / solid_angle;
    // Two triangles. Their common depth is that of the background.
    int k = gl_VertexIndex % 6;
    ivec2 corner = ivec2(k == 1 || k == 3 || k == 4, k == 2 || k == 4 || k == 5);
    vec2 pixel = floor(place - 0.5) + 2.0 * vec2(corner);
    gl_Position = vec4(pixel / push.size * 2.0 - 1.0, 0.0, 1.0);
}
