#include "display_values.glsl"

// From the smoothed picture of a moving view to that of a view at rest, in display values.

layout(set = 0, binding = 0) uniform sampler2D display; // of the view at rest
layout(set = 0, binding = 1) uniform sampler2D before;  // of the moving view

layout(push_constant, scalar) uniform Push {
    float share; // of the moving view, 0..1
    float shift; // of the rounding, 0..1
} push;

/// The picture at a pixel. rgb: display values; a: as many frames as count, of FRAMES.
vec4 handed_over(vec2 centre_of_pixel) {
    ivec2 pixel = ivec2(centre_of_pixel);
    vec3 c = texelFetch(display, pixel, 0).rgb;
    // Without a picture before, its contents are undefined.
    if (push.share > 0.0) {
        vec3 held = texelFetch(before, pixel, 0).rgb;
        vec3 mean = mix(light_of_display(c), light_of_display(held), push.share);
        c = rounded(display_of_light(mean), centre_of_pixel, push.shift);
    }
    return vec4(c, MOST_FRAMES / FRAMES);
}
