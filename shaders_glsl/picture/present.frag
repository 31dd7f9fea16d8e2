#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "colour.glsl"
#include "dither.glsl"
#include "hdr.glsl"

// Copies the picture to the window, scaled if their sizes differ, and encodes it for the screen.

layout(location = 0) out vec4 window; // with no encoding linear: the target's sRGB format encodes

// The user interface lies in an image of its own; else it is drawn over the window by its own pipeline.
layout(constant_id = 0) const bool LAYER = false;
// At most one encoding is set.
layout(constant_id = 1) const bool SRGB = false;
layout(constant_id = 2) const bool HDR10 = false;

layout(set = 0, binding = 0) uniform sampler2D display;
layout(set = 0, binding = 1) uniform sampler2D layer; // linear, alpha premultiplied; of the window's size

layout(push_constant, scalar) uniform Push {
    vec2 size;      // of the window, pixels
    float white;    // value of the display value 1 before the encoding; 1 unless the screen is HDR
    uint is_linear; // whether the display values are linear, else by the sRGB curve
} push;

void main() {
    ivec2 size = textureSize(display, 0);
    vec2 at = gl_FragCoord.xy * (vec2(size) / push.size);
    vec3 c = texelFetch(display, min(ivec2(at), size - 1), 0).rgb;
    if (push.is_linear == 0u) c = linear_from_srgb(c);
    if (LAYER) {
        vec4 over = texelFetch(layer, ivec2(gl_FragCoord.xy), 0);
        c = over.rgb + c * (1.0 - over.a);
    }
    c *= push.white;
    if (SRGB) c = srgb_from_linear(clamp(c, 0.0, 1.0));
    if (HDR10) c = dithered(pq_signal(BT2020_FROM_BT709 * c), uvec2(gl_FragCoord.xy), 1023.0);
    window = vec4(c, 1.0);
}
