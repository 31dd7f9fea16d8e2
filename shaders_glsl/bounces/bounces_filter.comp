#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "constants.glsl"
#include "octahedral.glsl"
#include "half_size.glsl"
#include "view.glsl"

// Spreads the light of the rays over the texels of the same surface around: an edge-avoiding kernel of five by five texels that are
// `step` apart (Dammertz et al. 2010, "Edge-Avoiding A-Trous Wavelet Transform for fast Global Illumination Filtering"). The rays of
// neighbours are independent, so their mean has less noise; it is blurred by the width of the kernel.

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform usampler2D bounced; // see half_size.glsl
layout(set = 0, binding = 1, rgba32ui) uniform writeonly uimage2DArray smoothed;
layout(set = 0, binding = 2, scalar) uniform View { VIEW_BLOCK } view;

layout(push_constant, scalar) uniform Push {
    ivec2 chosen; // pixel of each square of two by two
    vec2 size;    // of the picture, pixels
    int step;     // texels
} push;

// Weights of the kernel along an axis.
const float KERNEL[5] = float[](1.0, 2.0, 3.0, 2.0, 1.0);
// Largest distance from the plane of the surface, in steps.
const float OFF_PLANE = 0.5;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = textureSize(bounced, 0);
    if (any(greaterThanEqual(texel, size))) return;
    vec2 unit = 1.0 / vec2(size);
    uvec4 own = textureLod(bounced, (vec2(texel) + 0.5) * unit, 0.0);
    float distance = uintBitsToFloat(own.z);
    vec3 normal = normal_unpack(own.w);
    // A texel's height over the plane through the eye: its distance times a linear function of its place.
    vec3 n = normal * view.world_from_view;
    vec3 ray = view_ray((vec2(2 * texel + push.chosen) + 0.5) / push.size, view.ray_scale, view.ray_offset);
    vec2 per_texel = n.xy * 4.0 * view.ray_scale / push.size;
    float height = dot(n, ray);
    float width = 4.0 * abs(view.ray_scale.y) / push.size.y * distance * float(push.step);
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < 25; ++i) {
        ivec2 k = ivec2(i % 5, i / 5);
        vec2 offset = vec2((k - 2) * push.step);
        vec2 uv = (vec2(texel) + 0.5 + offset) * unit;
        uvec4 tap = textureLod(bounced, uv, 0.0);
        float there = uintBitsToFloat(tap.z);
        float off = abs(there * (height + dot(per_texel, offset)) - distance * height);
        bool is_inside = all(equal(uv, clamp(uv, 0.0, 1.0)));
        float w = is_inside && there > 0.0 ? KERNEL[k.x] * KERNEL[k.y] * sameness(normal, tap) * max(1.0 - off / (OFF_PLANE * width), 0.0) : 0.0;
        sum += w * shared_exponent_unpack(tap.y);
        weights += w;
    }
    if (weights > 0.0) own.y = shared_exponent_pack(sum / weights);
    imageStore(smoothed, ivec3(texel, 0), own);
}
