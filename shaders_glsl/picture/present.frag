#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "colour.glsl"

// Copies the picture to the window, scaled if their sizes differ. Its values are encoded: they are decoded, because the target's format encodes again.

layout(location = 0) out vec4 window; // linear; the target's sRGB format encodes

layout(set = 0, binding = 0) uniform sampler2D display;

layout(push_constant, scalar) uniform Push {
    vec2 size; // of the window, pixels
} push;

void main() {
    ivec2 size = textureSize(display, 0);
    vec2 at = gl_FragCoord.xy * (vec2(size) / push.size);
    window = vec4(linear_from_srgb(texelFetch(display, min(ivec2(at), size - 1), 0).rgb), 1.0);
}
