#version 460

// The picture with its mirrors: the sky in them, by the share V of it that is not hidden.

layout(location = 0) out vec4 radiance; // rgb: kcd/m^2; a: that of the picture

layout(set = 0, binding = 0) uniform sampler2D picture; // without mirrors
layout(set = 0, binding = 1) uniform sampler2D mirror;
layout(set = 0, binding = 2) uniform sampler2D lobe;

void main() {
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(picture, 0));
    vec4 reflected = textureLod(mirror, uv, 0.0);
    float whole = textureLod(lobe, uv, 0.0).r;
    // No direction in the lobe yet: nothing is known to hide the sky.
    float V = whole > 0.0 ? reflected.a / whole : 1.0;
    radiance = textureLod(picture, uv, 0.0) + vec4(V * reflected.rgb, 0.0);
}
