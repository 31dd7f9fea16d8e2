// The face under a pixel, and shadow maps compared in its plane. Needs `depth` and `view` declared before.

/// View-space position of a point uv of the picture at depth d.
vec3 in_view(vec2 uv, float d) {
    return view_ray(uv, view.ray_scale, view.ray_offset) * (view.near / d);
}

/// World normal of the face under a point uv of the picture, on the viewer's side: of the plane whose reversed depth changes with these slopes
/// (see face_slope.glsl).
vec3 face_normal(vec2 uv, uint slopes) {
    vec2 ray = view_ray(uv, view.ray_scale, view.ray_offset).xy;
    vec2 slope = unpackHalf2x16(slopes) / 256.0 * (0.5 * vec2(textureSize(depth, 0)) / view.ray_scale);
    return view.world_from_view * normal_of_slopes(slope, ray);
}

/// Whether a face turns its back to a light. Not where the shading normal n leans far from it, as that of leaves: there n decides.
bool is_turned_away(vec3 face, vec3 n, vec3 toward) {
    return dot(face, n) > 0.8 && dot(face, toward) <= 0.0;
}

// Share of the rise that rounding of a caster's corners to the sub-texel grid may make wrong.
const float RISE_ERROR = 0.02;

/// Whether a point of a face is lit by a shadow map (reversed: 1 is nearest the light), compared at the centre of the texel that
/// holds it with the depth that the face's plane has there: a plane cannot shadow itself, whatever its slope.
/// `clip`: from world; `planes`: its inverse transpose, which takes planes along; `window`: the map's first texel and its edges.
bool is_lit_in_plane(sampler2D map, mat4 clip, mat4 planes, vec4 window, float bias, vec3 world, vec3 face) {
    vec4 c = clip * vec4(world, 1.0);
    vec3 p = c.xyz / c.w;
    vec2 at = window.xy + (p.xy * 0.5 + 0.5) * window.zw;
    vec4 plane = planes * vec4(face, -dot(face, world));
    vec2 to_centre = (floor(at) + 0.5 - at) * 2.0 / window.zw;
    float rise = -dot(plane.xy, to_centre) / plane.z;
    vec2 last = window.xy + window.zw - 1.0;
    // A nearest lookup costs a software device less than a fetch, which it checks against the edges.
    vec2 uv = (clamp(floor(at), window.xy, last) + 0.5) / vec2(textureSize(map, 0));
    return textureLod(map, uv, 0.0).r <= p.z + rise + bias + RISE_ERROR * abs(rise);
}
