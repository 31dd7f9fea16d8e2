#version 460

// Edges between neighbouring pixels, by their display values: the first step of morphological anti-aliasing (Jimenez et al. 2012, "SMAA:
// Enhanced Subpixel Morphological Antialiasing", edges by colour).

layout(location = 0) out vec4 edges; // r: to the left neighbour, g: to the upper one; 1 is an edge

layout(set = 0, binding = 0) uniform sampler2D display; // display values

/// Least difference of a channel.
const float THRESHOLD = 0.1;

/// An edge is none beside one that is so many times stronger (SMAA's local contrast adaptation).
const float STRONGER = 2.0;

vec3 at(ivec2 pixel) {
    return texelFetch(display, clamp(pixel, ivec2(0), textureSize(display, 0) - 1), 0).rgb;
}

float apart(vec3 a, vec3 b) {
    vec3 d = abs(a - b);
    return max(d.r, max(d.g, d.b));
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec3 c = at(p), left = at(p - ivec2(1, 0)), top = at(p - ivec2(0, 1));
    vec2 delta = vec2(apart(c, left), apart(c, top));
    vec2 beyond = vec2(apart(left, at(p - ivec2(2, 0))), apart(top, at(p - ivec2(0, 2))));
    vec2 after = vec2(apart(c, at(p + ivec2(1, 0))), apart(c, at(p + ivec2(0, 1))));
    vec2 all = max(max(beyond, after), delta);
    float strongest = max(all.x, all.y);
    bvec2 is_edge = bvec2(delta.x >= THRESHOLD && delta.x * STRONGER >= strongest,
                          delta.y >= THRESHOLD && delta.y * STRONGER >= strongest);
    edges = vec4(is_edge, 0.0, 1.0);
}
