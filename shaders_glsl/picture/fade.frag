#version 460
#extension GL_EXT_scalar_block_layout : require

// Cross-fade from the preview to the converging picture.

layout(location = 0) out vec4 radiance; // rgb: kcd/m^2, or the quantity shown; a: illuminance, klx

layout(set = 0, binding = 0) uniform sampler2D preview;
layout(set = 0, binding = 1) uniform sampler2D converging;

layout(push_constant, scalar) uniform Push {
    float share; // weight of the preview, 0..1
} push;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    radiance = texelFetch(converging, pixel, 0);
    // Without a preview the image's contents are undefined and may be NaN.
    if (push.share > 0.0) radiance = mix(radiance, texelFetch(preview, pixel, 0), push.share);
}
