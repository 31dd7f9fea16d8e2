// Cross-fade from the preview to the converging picture.

layout(set = 0, binding = 0) uniform sampler2D preview;
layout(set = 0, binding = 1) uniform sampler2D converging;

layout(push_constant, scalar) uniform Push {
    float share; // weight of the preview, 0..1
} push;

/// rgb: kcd/m^2, or the quantity shown; a: illuminance, klx.
vec4 faded(ivec2 pixel) {
    vec4 radiance = texelFetch(converging, pixel, 0);
    // Without a preview the image's contents are undefined and may be NaN.
    if (push.share > 0.0) radiance = mix(radiance, texelFetch(preview, pixel, 0), push.share);
    return radiance;
}
