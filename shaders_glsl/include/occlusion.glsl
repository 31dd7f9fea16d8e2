// Texels of the ambient occlusion: the distance along the view axis (m) in the upper 22 bits, with a relative error of 3e-5, and
// ten bits of A. One lookup instead of two, and no conversion from half floats.

/// Distance of pixels without a surface, metres: beyond any radius.
const float NOWHERE = 1e18;

/// Distance along the view axis of a reversed depth, metres.
float distance_of_depth(float d, float near) {
    return d > 0.0 ? near / d : NOWHERE;
}

uint distance_pack(float distance) {
    return ((floatBitsToUint(distance) + 0x100u) >> 9) << 10;
}

/// Distance along the view axis, metres.
float packed_distance(uint word) {
    return uintBitsToFloat((word >> 1) & 0x7ffffe00u);
}

// A is stored as 1 minus a multiple of this: single slices go down to 1 - pi/2. A word of 0 is A = 1 at distance 0.
const float OCCLUSION_STEP = 1.0 / 640.0;

/// Packs a surface's distance and its ambient occlusion A, 1 - pi/2 .. 1.
uint occlusion_pack(float a, float distance) {
    return distance_pack(distance) | uint(clamp((1.0 - a) / OCCLUSION_STEP + 0.5, 0.0, 1023.0));
}

/// A, and the distance along the view axis (m).
vec2 occlusion_unpack(uint word) {
    return vec2(1.0 - float(int(word & 1023u)) * OCCLUSION_STEP, packed_distance(word));
}

/// A, upsampled without crossing depth edges. Texel k of the occlusion belongs to pixel k * downscale of the picture.
float ambient_occlusion(usampler2D occlusion, int downscale, ivec2 pixel, float distance) {
    vec2 at = vec2(pixel) / float(downscale);
    vec2 base = floor(at);
    vec2 f = at - base, g = 1.0 - f;
    vec2 uv = (base + 0.5) / vec2(textureSize(occlusion, 0));
    // Lookups with constant offsets share one coordinate computation.
    uvec4 words = uvec4(textureLod(occlusion, uv, 0.0).r, textureLodOffset(occlusion, uv, 0.0, ivec2(1, 0)).r,
                        textureLodOffset(occlusion, uv, 0.0, ivec2(0, 1)).r, textureLodOffset(occlusion, uv, 0.0, ivec2(1, 1)).r);
    vec4 bilinear = vec4(g.x * g.y, f.x * g.y, g.x * f.y, f.x * f.y);
    vec2 sum = vec2(0.0);
    for (int i = 0; i < 4; ++i) {
        vec2 tap = occlusion_unpack(words[i]);
        // The small terms keep the weights finite, and texels across an edge count if there are no others.
        float w = (bilinear[i] + 1e-3) / (1e-3 * distance + abs(tap.g - distance));
        sum += vec2(tap.r, 1.0) * w;
    }
    return sum.r / sum.g;
}
