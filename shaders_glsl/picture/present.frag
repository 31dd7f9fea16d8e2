#version 460
#extension GL_EXT_scalar_block_layout : require

// Copies the picture to the window; scales it while their sizes differ.

layout(location = 0) out vec4 window; // linear; the target's sRGB format encodes

// The picture holds encoded values: decode, because the target's format encodes again.
layout(constant_id = 0) const bool ENCODED = false;

layout(set = 0, binding = 0) uniform sampler2D display;

layout(push_constant, scalar) uniform Push {
    vec2 size; // of the window, pixels
} push;

vec3 srgb_decode(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

void main() {
    ivec2 size = textureSize(display, 0);
    vec2 at = gl_FragCoord.xy * (vec2(size) / push.size);
    vec3 c = texelFetch(display, min(ivec2(at), size - 1), 0).rgb;
    window = vec4(ENCODED ? srgb_decode(c) : c, 1.0);
}
