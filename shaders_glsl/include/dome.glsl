// The dome's directions in a frame, and their shadow maps: tiles of one image.
#include "face.glsl"

layout(set = 0, binding = 6) uniform sampler2D maps; // reversed: 1 is nearest the light
layout(set = 0, binding = 9, scalar) uniform Dome {
    mat4 clip_from_world[16];
    mat4 planes[16]; // inverse transposes of clip_from_world
    vec4 window[16]; // first texel of the map and its edge lengths
    vec4 toward[16]; // unit, toward the light; a: depth bias
    vec4 light[16];  // contribution to the irradiance at normal incidence, klx; a: 1 for the sky, 0 for the ground
} dome;

/// Whether the map of direction k shows nothing between the light and a point of a face.
bool is_lit_in_map(int k, vec3 world, vec3 face) {
    return is_lit_in_plane(maps, dome.clip_from_world[k], dome.planes[k], dome.window[k], dome.toward[k].a, world, face);
}

/// Whether the light of direction k reaches a point of a face with shading normal n, by its map.
bool is_lit_from(int k, vec3 world, vec3 n, vec3 face) {
    return !is_turned_away(face, n, dome.toward[k].xyz) && is_lit_in_map(k, world, face);
}
