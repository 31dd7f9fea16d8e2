// The face at a pixel, and shadow comparison in its plane. Reversed depth d is linear over the picture, so two slopes describe
// a triangle's plane exactly, even for triangles a few pixels wide, where differences to neighbouring pixels fail.
#include "texel.glsl"
#include "view.glsl"

// Slopes are stored as half floats. The scale keeps small slopes out of the denormal range; the limit clamps those of edge-on
// triangles, which a half cannot represent.
const float SLOPE_SCALE = 256.0;
const float MAX_SLOPE = 100.0;

/// Relative changes of depth from pixel to pixel, as two halves.
uint slopes_pack(vec2 slopes) {
    return packHalf2x16(clamp(slopes, -MAX_SLOPE, MAX_SLOPE) * SLOPE_SCALE);
}

/// View-space normal of the face at a pixel, on the viewer's side. `slopes`: from `slopes_pack`; `ray`: x and y of the pixel's
/// ray with z = -1; `pixels_per_ray`: pixels per unit of x and of y.
vec3 face_normal(uint slopes, vec2 ray, vec2 pixels_per_ray) {
    return normal_of_slopes(unpackHalf2x16(slopes) / SLOPE_SCALE * pixels_per_ray, ray);
}

// Cosine between face and shading normal above which they count as the same surface: 37 degrees.
const float SAME_FACE = 0.8;

/// Whether a face is turned away from a light. False if the shading normal n deviates far from the face, as on leaves: n decides
/// there.
bool is_turned_away(vec3 face, vec3 n, vec3 toward) {
    return dot(face, n) > SAME_FACE && dot(face, toward) <= 0.0;
}

// Relative error of the rise from rounding a caster's vertices to the sub-texel grid.
const float RISE_ERROR = 0.02;

/// Whether a point of a face is lit, by a shadow map (reversed: 1 is nearest the light). The depth of the face's plane is compared
/// at the centre of the texel that contains the point: a plane cannot shadow itself, whatever its slope.
/// `clip`: clip from world; `planes`: its inverse transpose, for planes; `window`: first texel of the map and its edge lengths.
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

/// Whether a point of a face is lit, and whether the texels around it do not agree.
struct LitInPlane {
    bool is_lit;
    bool is_edge;
};

/// As `is_lit_in_plane`, with the eight texels around. A texel is dark for that without the bias, which would hide the foot of a wall.
LitInPlane lit_in_plane(sampler2D map, mat4 clip, mat4 planes, vec4 window, float bias, vec3 world, vec3 face) {
    vec4 c = clip * vec4(world, 1.0);
    vec3 p = c.xyz / c.w;
    vec2 at = window.xy + (p.xy * 0.5 + 0.5) * window.zw;
    vec4 plane = planes * vec4(face, -dot(face, world));
    vec2 slope = -plane.xy / plane.z * 2.0 / window.zw;
    vec2 last = window.xy + window.zw - 1.0;
    bool is_lit = false, any_lit = false, any_dark = false;
    for (int i = 0; i < 9; ++i) {
        vec2 texel = floor(at) + vec2(i % 3 - 1, i / 3 - 1);
        float rise = dot(slope, texel + 0.5 - at);
        float before = texel_at(map, clamp(texel, window.xy, last)).r - p.z - rise - RISE_ERROR * abs(rise);
        if (i == 4) is_lit = before <= bias;
        any_lit = any_lit || before <= bias;
        any_dark = any_dark || before > 0.0;
    }
    return LitInPlane(is_lit, any_lit && any_dark);
}
