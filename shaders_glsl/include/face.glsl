// The face under a pixel, and shadow maps compared in its plane. Reversed depth d is linear over the picture: two slopes
// describe a triangle's plane, exactly, also where a triangle is a few pixels wide and differences to neighbours fail.
#include "texel.glsl"
#include "view.glsl"

/// The shading normal on the viewer's side, of any length. Winding and stored normals of real models disagree too often to
/// trust either: the true face, from derivatives, decides the side; surfaces are two-sided.
/// `slack` (0..1): a normal is turned only if its cosine with the face is less than minus this.
vec3 facing_normal(vec3 shading_normal, vec3 from_eye, float slack) {
    vec3 face = cross(dFdx(from_eye), dFdy(from_eye));
    face *= dot(face, from_eye) > 0.0 ? -1.0 : 1.0;
    float limit = slack > 0.0 ? -slack * length(face) * length(shading_normal) : 0.0;
    return dot(shading_normal, face) < limit ? -shading_normal : shading_normal;
}

// Slopes are kept as halves: the scale keeps gentle ones out of their denormal range, the limit holds those of a triangle seen
// from its edge, which a half cannot.
const float SLOPE_SCALE = 256.0;
const float MAX_SLOPE = 100.0;

/// Relative change of depth from pixel to pixel, as two halves.
uint face_slopes() {
    vec2 slopes = vec2(dFdx(gl_FragCoord.z), dFdy(gl_FragCoord.z)) / gl_FragCoord.z;
    return packHalf2x16(clamp(slopes, -MAX_SLOPE, MAX_SLOPE) * SLOPE_SCALE);
}

/// View-space normal of the face under a pixel, on the viewer's side. `slopes`: of `face_slopes`; `ray`: x and y of the pixel's
/// ray with z = -1; `pixels_per_ray`: pixels to a unit of x and of y.
vec3 face_normal(uint slopes, vec2 ray, vec2 pixels_per_ray) {
    return normal_of_slopes(unpackHalf2x16(slopes) / SLOPE_SCALE * pixels_per_ray, ray);
}

// Cosine between face and shading normal above which they are taken for the same surface: 37 degrees.
const float SAME_FACE = 0.8;

/// Whether a face turns its back to a light. Not where the shading normal n leans far from it, as that of leaves: there n decides.
bool is_turned_away(vec3 face, vec3 n, vec3 toward) {
    return dot(face, n) > SAME_FACE && dot(face, toward) <= 0.0;
}

// Share of the rise that rounding of a caster's corners to the sub-texel grid may make wrong.
const float RISE_ERROR = 0.02;

/// Whether a point of a face is lit by a shadow map (reversed: 1 is nearest the light), compared at the centre of the texel that
/// holds it with the depth that the face's plane has there: a plane cannot shadow itself, whatever its slope.
/// `clip`: from world; `planes`: its inverse transpose, which transforms planes; `window`: the map's first texel and its edges.
bool is_lit_in_plane(sampler2D map, mat4 clip, mat4 planes, vec4 window, float bias, vec3 world, vec3 face) {
    vec4 c = clip * vec4(world, 1.0);
    vec3 p = c.xyz / c.w;
    vec2 at = window.xy + (p.xy * 0.5 + 0.5) * window.zw;
    vec4 plane = planes * vec4(face, -dot(face, world));
    vec2 to_centre = (floor(at) + 0.5 - at) * 2.0 / window.zw;
    float rise = -dot(plane.xy, to_centre) / plane.z;
    vec2 last = window.xy + window.zw - 1.0;
    return texel_at(map, clamp(floor(at), window.xy, last)).r <= p.z + rise + bias + RISE_ERROR * abs(rise);
}
