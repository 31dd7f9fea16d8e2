// Irradiance at half the size of the picture, and its upsampling. A texel is for one pixel of a square of two by two: which one
// changes from frame to frame. Needs octahedral.glsl.
#include "shared_exponent.glsl"

/// Irradiance of the sky and of the bounces, klx.
struct Ambient {
    vec3 sky;
    vec3 bounce;
};

/// A texel: both irradiances, distance along the view axis (metres), normal. All 0 is background.
uvec4 half_size_pack(Ambient light, float distance, uint normal) {
    return uvec4(irradiance_pack(light.sky), irradiance_pack(light.bounce), floatBitsToUint(distance), normal);
}

// Squarings of the cosine between normals in the weights: cos^8.
const int SHARPNESS = 3;

/// How far a texel has the same normal, 0..1.
float sameness(vec3 n, uvec4 texel) {
    float same = max(dot(n, normal_unpack(texel.w)), 0.0);
    for (int k = 0; k < SHARPNESS; ++k) same *= same;
    return same;
}

/// Irradiance at a pixel, interpolated between texels of the same surface. `chosen`: the pixel of each square that has the texel.
Ambient half_size_at(usampler2D image, ivec2 pixel, ivec2 chosen, float distance, vec3 n) {
    vec2 at = 0.5 * vec2(pixel - chosen);
    vec2 base = floor(at);
    vec2 f = at - base, g = 1.0 - f;
    vec4 bilinear = vec4(g.x * g.y, f.x * g.y, g.x * f.y, f.x * f.y);
    vec2 size = vec2(textureSize(image, 0));
    vec3 sky = vec3(0.0), bounce = vec3(0.0);
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 texel = base + vec2(i & 1, i >> 1);
        uvec4 tap = textureLod(image, (texel + 0.5) / size, 0.0);
        float there = uintBitsToFloat(tap.z);
        float same = sameness(n, tap);
        // The small terms keep the weights finite, and other surfaces count if there is nothing else.
        float w = there > 0.0 ? (bilinear[i] + 1e-3) * (same + 1e-3) / (1e-3 * distance + abs(there - distance)) : 0.0;
        sky += w * irradiance_unpack(tap.x);
        bounce += w * irradiance_unpack(tap.y);
        sum += w;
    }
    float scale = sum > 0.0 ? 1.0 / sum : 0.0;
    return Ambient(sky * scale, bounce * scale);
}
