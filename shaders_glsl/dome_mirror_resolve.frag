#version 460

// The picture with its mirrors: the sky in them, by the share V of it that is not hidden.

layout(location = 0) out vec4 radiance; // kcd/m^2

layout(set = 0, binding = 0) uniform sampler2D picture; // without mirrors
layout(set = 0, binding = 1) uniform sampler2D mirror;
layout(set = 0, binding = 2) uniform sampler2D lobe;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 reflected = texelFetch(mirror, pixel, 0);
    float whole = texelFetch(lobe, pixel, 0).r;
    // No direction in the lobe yet: nothing is known to hide the sky.
    float V = whole > 0.0 ? reflected.a / whole : 1.0;
    radiance = vec4(texelFetch(picture, pixel, 0).rgb + V * reflected.rgb, 1.0);
}
