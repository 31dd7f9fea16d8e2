#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "display_values.glsl"

// Morphological anti-aliasing of display values: from the steps of a line of edges follows the straight line that it stands for, and from that the
// share of a pixel on the other side (Reshetov 2009, "Morphological Antialiasing"; shapes as in Jimenez et al. 2012, without diagonals).

layout(location = 0) out vec4 picture; // rgb: display values

layout(set = 0, binding = 0) uniform sampler2D display; // display values
layout(set = 0, binding = 1) uniform sampler2D edges;   // r: to the left neighbour, g: to the upper one

/// Longest search along a line of edges, pixels.
const int LONGEST = 24;

vec2 edges_at(ivec2 pixel) {
    return texelFetch(edges, clamp(pixel, ivec2(0), textureSize(edges, 0) - 1), 0).rg;
}

/// Areas on both sides of the axis, within x..x + 1, under a line from a to b, a.x < b.x: above 0, below 0.
vec2 under(vec2 a, vec2 b, float x) {
    float from = max(x, a.x), to = min(x + 1.0, b.x);
    if (from >= to) return vec2(0.0);
    float slope = (b.y - a.y) / (b.x - a.x);
    float y = a.y + (from - a.x) * slope, z = a.y + (to - a.x) * slope, width = to - from;
    if (y * z >= 0.0) {
        float area = 0.5 * (y + z) * width;
        return vec2(max(area, 0.0), max(-area, 0.0));
    }
    float t = y / (y - z);
    float first = 0.5 * abs(y) * t * width, second = 0.5 * abs(z) * (1.0 - t) * width;
    return y > 0.0 ? vec2(first, second) : vec2(second, first);
}

/// Areas of a line of edges of this length that turns to the side `start` (1: to this side, -1: to the other, 0: not) at its start and `end` at its
/// end: in the pixel at x on this side, and in its neighbour on the other.
vec2 covered(float start, float end, float length, float x) {
    if (start * end < 0.0) return under(vec2(0.0, 0.5 * start), vec2(length, 0.5 * end), x);
    vec2 middle = vec2(0.5 * length, 0.0), sum = vec2(0.0);
    if (start != 0.0) sum += under(vec2(0.0, 0.5 * start), middle, x);
    if (end != 0.0) sum += under(middle, vec2(length, 0.5 * end), x);
    return sum;
}

/// Shares for the edge of a pixel toward `-across`: of the neighbour's colour in the pixel, and of the pixel's in the neighbour. The edge is in
/// `channel`; edges that cross its line in the other.
vec2 shares(ivec2 pixel, ivec2 along, ivec2 across, int channel) {
    bool is_edge = edges_at(pixel)[channel] > 0.5;
    if (!is_edge) return vec2(0.0);
    // Not a constant: compilers would unroll the loops, and software devices then run through all of them.
    int longest = min(LONGEST, textureSize(edges, 0).x);
    int crossing = 1 - channel;
    ivec2 p = pixel;
    float before = 0.0, start = 0.0;
    for (int i = 0; i < longest; ++i) {
        start = edges_at(p)[crossing] - edges_at(p - across)[crossing];
        bool is_crossed = max(edges_at(p)[crossing], edges_at(p - across)[crossing]) > 0.5;
        if (is_crossed || edges_at(p - along)[channel] < 0.5) break;
        p -= along;
        before += 1.0;
    }
    p = pixel + along;
    float after = 0.0, end = 0.0;
    for (int i = 0; i < longest; ++i) {
        end = edges_at(p)[crossing] - edges_at(p - across)[crossing];
        bool is_crossed = max(edges_at(p)[crossing], edges_at(p - across)[crossing]) > 0.5;
        if (is_crossed || edges_at(p)[channel] < 0.5) break;
        p += along;
        after += 1.0;
    }
    return covered(start, end, before + after + 1.0, before);
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), last = textureSize(display, 0) - 1;
    const ivec2 right = ivec2(1, 0), down = ivec2(0, 1);
    // Shares of the neighbours: above, below, left, right.
    float above = shares(p, right, down, 1).x, below = shares(p + down, right, down, 1).y;
    float left = shares(p, down, right, 0).x, beside = shares(p + right, down, right, 0).y;
    bool is_upright = max(above, below) >= max(left, beside);
    vec2 share = is_upright ? vec2(above, below) : vec2(left, beside);
    ivec2 across = is_upright ? down : right;
    vec3 own = texelFetch(display, p, 0).rgb;
    vec3 before = light_of_display(texelFetch(display, clamp(p - across, ivec2(0), last), 0).rgb);
    vec3 after = light_of_display(texelFetch(display, clamp(p + across, ivec2(0), last), 0).rgb);
    vec3 mean = light_of_display(own) * (1.0 - share.x - share.y) + before * share.x + after * share.y;
    picture = vec4(share == vec2(0.0) ? own : display_of_light(mean), 1.0);
}
