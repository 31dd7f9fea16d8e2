// The directions of a frame of the dome, and their shadow maps: tiles of one image.
#include "face.glsl"

layout(set = 0, binding = 6) uniform sampler2D maps; // reversed: 1 is nearest the light
layout(set = 0, binding = 9, scalar) uniform Dome {
    mat4 clip_from_world[16];
    mat4 planes[16]; // their inverse transposes
    vec4 window[16]; // first texel of the map and its edges
    vec4 toward[16]; // unit, toward the light; a: depth bias
    vec4 light[16];  // share of the irradiance at normal incidence, klx; a: 1 of the sky, 0 of the ground
} dome;

/// Whether the light of direction k reaches a point of a face with shading normal n.
bool is_lit_from(int k, vec3 world, vec3 n, vec3 face) {
    vec4 toward = dome.toward[k];
    if (is_turned_away(face, n, toward.xyz)) return false;
    return is_lit_in_plane(maps, dome.clip_from_world[k], dome.planes[k], dome.window[k], toward.a, world, face);
}
