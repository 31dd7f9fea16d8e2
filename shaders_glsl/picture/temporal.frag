#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "display_values.glsl"

// Temporal anti-aliasing of display values: each frame samples another point of the pixels, and the picture before, moved along with the
// camera, adds the samples of the frames before (Karis 2014, "High Quality Temporal Supersampling"). Display values are between 0 and
// white, so that no single bright sample decides a pixel.
//
// The scene stands still, so the motion of a pixel follows from its depth alone. What was seen there before is another surface if its depth
// would have moved it elsewhere. Only then, or when the light changes, is the picture before bounded by what is around the pixel now: else
// thin parts, which most frames miss, would flicker.

layout(location = 0) out vec4 picture; // rgb: display values; a: number of frames in it, of FRAMES

layout(set = 0, binding = 0) uniform sampler2D display;            // this frame, display values
layout(set = 0, binding = 1) uniform sampler2D depth;              // of this frame: near / distance
layout(set = 0, binding = 2) uniform sampler2D before;             // the picture before
layout(set = 0, binding = 3) uniform sampler2D depth_before;
layout(set = 0, binding = 4) uniform sampler2D average_luminance;  // that the exposure follows, one texel
layout(set = 0, binding = 5) uniform sampler2D previous_luminance; // the same of the frame before

layout(push_constant, scalar) uniform Push {
    vec4 to_u;      // from (pixel, depth, 1) to u of the picture before, times w
    vec4 to_v;
    vec4 to_w;
    float to_depth; // from depth to that of the picture before, times w
    float parallax; // largest motion between two surfaces that differ by 1 in depth, pixels
    float most;     // frames that count in the picture before
    float follows;  // 1: the light is that of the picture before; 0: it has changed
    float shift;    // of the rounding, 0..1: another one for every frame
} push;

const float FRAMES = 255.0;

/// Motion between two surfaces up to which they count as one, pixels.
const float SAME = 0.125;

/// Relative change of the exposure from which the picture before is of another exposure.
const float EXPOSED = 0.02;

/// Frames that count of a picture before which had to be bounded.
const float BOUNDED = 3.0;

/// Whether the exposure has hardly changed.
float is_exposed_alike() {
    float a = texelFetch(average_luminance, ivec2(0), 0).r, b = texelFetch(previous_luminance, ivec2(0), 0).r;
    return abs(a - b) <= EXPOSED * min(a, b) ? 1.0 : 0.0;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = textureSize(display, 0) - 1;
    ivec2 low = max(pixel - 1, ivec2(0)), high = min(pixel + 1, last);
    ivec2 beside[4] = ivec2[4](ivec2(low.x, pixel.y), ivec2(high.x, pixel.y), ivec2(pixel.x, low.y), ivec2(pixel.x, high.y));

    // The least and greatest values around, and the nearest surface: the edge of what is in front moves with it.
    vec3 now = texelFetch(display, pixel, 0).rgb, least = now, most = now;
    float own = texelFetch(depth, pixel, 0).r, nearest = own;
    for (int i = 0; i < 4; ++i) {
        vec3 c = texelFetch(display, beside[i], 0).rgb;
        least = min(least, c);
        most = max(most, c);
        nearest = max(nearest, texelFetch(depth, beside[i], 0).r);
    }

    vec4 here = vec4(gl_FragCoord.xy, nearest, 1.0);
    float w = dot(push.to_w, here);
    vec2 at = vec2(dot(push.to_u, here), dot(push.to_v, here)) / w;
    bool is_seen = push.most > 0.0 && w > 0.0 && all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(1.0)));
    float expected = push.to_depth * nearest / w;
    float found = texelFetch(depth_before, clamp(ivec2(at * vec2(last + 1)), ivec2(0), last), 0).r;
    // At an edge the frame before may have met either surface.
    float differs = min(abs(found - expected), abs(found - expected - (own - nearest)));
    float trust = clamp(2.0 - differs * push.parallax / SAME, 0.0, 1.0) * push.follows * is_exposed_alike();

    vec4 old = textureLod(before, at, 0.0);
    old.rgb = mix(clamp(old.rgb, least, most), old.rgb, trust);
    float count = min(old.a * FRAMES, mix(min(BOUNDED, push.most), push.most, trust));
    if (!is_seen) count = 0.0;
    // A picture before that does not count may be undefined.
    vec3 mean = light_of_display(now);
    if (count > 0.0) mean = mix(light_of_display(old.rgb), mean, 1.0 / (count + 1.0));
    picture = vec4(rounded(display_of_light(mean), gl_FragCoord.xy, push.shift), (count + 1.0) / FRAMES);
}
