#include "occluder.glsl"

/// A, upsampled without crossing depth edges. Texel k of the occlusion was computed at pixel k * downscale of the picture.
float ambient_occlusion(usampler2D occlusion, int downscale, ivec2 pixel, float distance) {
    vec2 at = vec2(pixel) / float(downscale);
    vec2 base = floor(at);
    vec2 f = at - base, g = 1.0 - f;
    vec2 uv = (base + 0.5) / vec2(textureSize(occlusion, 0));
    // Of nearest lookups with an offset: they cost a software device less than fetches.
    uvec4 words = uvec4(textureLod(occlusion, uv, 0.0).r, textureLodOffset(occlusion, uv, 0.0, ivec2(1, 0)).r,
                        textureLodOffset(occlusion, uv, 0.0, ivec2(0, 1)).r, textureLodOffset(occlusion, uv, 0.0, ivec2(1, 1)).r);
    vec4 bilinear = vec4(g.x * g.y, f.x * g.y, g.x * f.y, f.x * f.y);
    vec2 sum = vec2(0.0);
    for (int i = 0; i < 4; ++i) {
        vec2 tap = occlusion_unpack(words[i]);
        float w = (bilinear[i] + 1e-3) / (1e-3 * distance + abs(tap.g - distance));
        sum += vec2(tap.r, 1.0) * w;
    }
    return sum.r / sum.g;
}
