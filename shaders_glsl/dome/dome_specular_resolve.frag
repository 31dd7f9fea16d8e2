#version 460

// Adds specular reflection of the sky, weighted by its visible fraction V, to the picture.

layout(location = 0) out vec4 radiance; // rgb: kcd/m^2; a: that of the picture

layout(set = 0, binding = 0) uniform sampler2D picture; // without sky reflection
layout(set = 0, binding = 1) uniform sampler2D reflected;
layout(set = 0, binding = 2) uniform sampler2D lobe;

void main() {
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(picture, 0));
    vec4 mean = textureLod(reflected, uv, 0.0);
    float whole = textureLod(lobe, uv, 0.0).r;
    // With no direction in the lobe yet, the sky counts as unoccluded.
    float V = whole > 0.0 ? mean.a / whole : 1.0;
    radiance = textureLod(picture, uv, 0.0) + vec4(V * mean.rgb, 0.0);
}
