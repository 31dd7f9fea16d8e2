#include "occluder.glsl"

/// A, upsampled without crossing depth edges. Texel k of the occlusion was computed at pixel k * downscale of the picture.
float ambient_occlusion(usampler2D occlusion, int downscale, ivec2 pixel, float distance) {
    vec2 at = vec2(pixel) / float(downscale);
    ivec2 base = ivec2(floor(at));
    vec2 f = at - vec2(base);
    ivec2 last = textureSize(occlusion, 0) - 1;
    vec2 sum = vec2(0.0);
    for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < 2; ++x) {
            vec2 tap = occlusion_unpack(texelFetch(occlusion, min(base + ivec2(x, y), last), 0).r);
            float bilinear = (x == 0 ? 1.0 - f.x : f.x) * (y == 0 ? 1.0 - f.y : f.y);
            float w = (bilinear + 1e-3) / (1e-3 + abs(tap.g - distance) / distance);
            sum += vec2(tap.r, 1.0) * w;
        }
    }
    return sum.r / sum.g;
}
