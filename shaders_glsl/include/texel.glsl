#ifndef TEXEL_GLSL
#define TEXEL_GLSL
// Texels by nearest lookups: a software device checks each fetch against the edges, lookups cost it less.

/// Texel p (whole numbers) of an image with a nearest sampler; past the edge the last one.
vec4 texel_at(sampler2D image, vec2 p) {
    return textureLod(image, (p + 0.5) / vec2(textureSize(image, 0)), 0.0);
}

uvec4 texel_at(usampler2D image, vec2 p) {
    return textureLod(image, (p + 0.5) / vec2(textureSize(image, 0)), 0.0);
}
#endif
