#ifndef TEXEL_GLSL
#define TEXEL_GLSL
// Texel reads as nearest lookups: on a software device they cost less than fetches, which are bounds-checked.

/// Texel p (whole numbers) of an image with a nearest sampler, clamped to the edge.
vec4 texel_at(sampler2D image, vec2 p) {
    return textureLod(image, (p + 0.5) / vec2(textureSize(image, 0)), 0.0);
}

uvec4 texel_at(usampler2D image, vec2 p) {
    return textureLod(image, (p + 0.5) / vec2(textureSize(image, 0)), 0.0);
}
#endif
