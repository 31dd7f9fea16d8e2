// Adds specular reflection of the sky, weighted by its visible fraction V, to the picture.

layout(set = 0, binding = 0) uniform sampler2D picture; // without sky reflection
layout(set = 0, binding = 1) uniform sampler2D reflected;
layout(set = 0, binding = 2) uniform sampler2D lobe;

/// The picture; `at`: the pixel's centre. rgb: kcd/m^2; a: that of the picture.
vec4 with_reflection(vec2 at) {
    vec2 uv = at / vec2(textureSize(picture, 0));
    vec4 mean = textureLod(reflected, uv, 0.0);
    float whole = textureLod(lobe, uv, 0.0).r;
    // With no direction in the lobe yet, the sky counts as unoccluded.
    float V = whole > 0.0 ? mean.a / whole : 1.0;
    return textureLod(picture, uv, 0.0) + vec4(V * mean.rgb, 0.0);
}
