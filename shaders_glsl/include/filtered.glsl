#ifndef FILTERED_GLSL
#define FILTERED_GLSL
// Linear lookups in images of 32-bit floats, whose samplers some devices cannot filter.
#include "cube.glsl"

layout(constant_id = 50) const bool FILTERED = true; // whether samplers do; if not, they are nearest ones

/// Texel of a level of a cube, seamless: up to one texel beyond the edge of a face it is that of the next face. Alpha is 1, but 0 beyond
/// a corner, where there is none.
vec4 cube_tap(samplerCube map, int face, vec2 texel, float edge, int level) {
    vec2 c = (texel + 0.5) / edge * 2.0 - 1.0;
    bvec2 outside = greaterThan(abs(c), vec2(1.0));
    if (all(outside)) return vec4(0.0);
    // Beyond the edge the axes of the face shrink by as much as the texel is beyond it.
    if (any(outside)) c *= mix(vec2(1.0 + 1.0 / edge), vec2(1.0), outside);
    return vec4(textureLod(map, cube_direction(face, c * 0.5 + 0.5), float(level)).rgb, 1.0);
}

vec3 cube_level(samplerCube map, vec3 direction, int level) {
    vec2 st;
    int face = cube_face(direction, st);
    float edge = float(textureSize(map, level).x);
    vec2 at = st * edge - 0.5, f = fract(at), low = floor(at);
    vec4 a = cube_tap(map, face, low, edge, level), b = cube_tap(map, face, low + vec2(1.0, 0.0), edge, level);
    vec4 c = cube_tap(map, face, low + vec2(0.0, 1.0), edge, level), d = cube_tap(map, face, low + vec2(1.0), edge, level);
    vec4 sum = mix(mix(a, b, f.x), mix(c, d, f.x), f.y);
    // What is missing at a corner is the mean of the other three (Vulkan specification, "Cube Map Edge Handling").
    return sum.rgb + (1.0 - sum.a) / 3.0 * (a + b + c + d).rgb;
}

/// Bilinear in a level, linear between levels; alpha is 1.
vec4 filtered(samplerCube map, vec3 direction, float level) {
    if (FILTERED) return textureLod(map, direction, level);
    float within = clamp(level, 0.0, float(textureQueryLevels(map) - 1));
    vec3 fine = cube_level(map, direction, int(within));
    if (fract(within) == 0.0) return vec4(fine, 1.0);
    return vec4(mix(fine, cube_level(map, direction, int(within) + 1), fract(within)), 1.0);
}

/// Bilinear at `at` texels from the centre of the first one.
vec4 filtered(sampler2D map, vec2 at) {
    ivec2 size = textureSize(map, 0);
    if (FILTERED) return textureLod(map, (at + 0.5) / vec2(size), 0.0);
    vec2 f = fract(at);
    ivec2 low = ivec2(floor(at)), last = size - 1;
    ivec2 a = clamp(low, ivec2(0), last), b = clamp(low + 1, ivec2(0), last);
    vec4 near = mix(texelFetch(map, a, 0), texelFetch(map, ivec2(b.x, a.y), 0), f.x);
    vec4 far = mix(texelFetch(map, ivec2(a.x, b.y), 0), texelFetch(map, b, 0), f.x);
    return mix(near, far, f.y);
}
#endif
