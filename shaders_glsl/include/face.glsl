// The face under a pixel, and shadow maps compared in its plane. Needs `depth` and `view` declared before.

/// View-space position of a pixel's sample at depth d.
vec3 in_view(ivec2 pixel, float d) {
    vec2 uv = (vec2(pixel) + 0.5) / vec2(textureSize(depth, 0));
    return view_ray(uv, view.ray_scale, view.ray_offset) * (view.near / d);
}

/// From a pixel to the neighbour, on either side, that lies on the same face: the one of less change in depth.
vec3 along(ivec2 pixel, ivec2 unit, float d, vec3 p) {
    ivec2 last = textureSize(depth, 0) - 1;
    ivec2 a = max(pixel - unit, ivec2(0));
    ivec2 b = min(pixel + unit, last);
    float da = texelFetch(depth, a, 0).r;
    float db = texelFetch(depth, b, 0).r;
    bool first = b == pixel || (a != pixel && abs(da - d) < abs(db - d));
    return first ? p - in_view(a, max(da, 1e-9)) : in_view(b, max(db, 1e-9)) - p;
}

/// World normal of the face itself, on the viewer's side. Where no neighbour lies on it, the shading normal n.
vec3 face_normal(ivec2 pixel, float d, vec3 n) {
    vec3 p = in_view(pixel, d);
    vec3 g = cross(along(pixel, ivec2(1, 0), d, p), along(pixel, ivec2(0, 1), d, p));
    g = view.world_from_view * normalize(dot(g, p) > 0.0 ? -g : g);
    return dot(g, n) > 0.8 ? g : n;
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
    ivec2 texel = ivec2(clamp(floor(at), window.xy, last));
    return texelFetch(map, texel, 0).r <= p.z + rise + bias + RISE_ERROR * abs(rise);
}
