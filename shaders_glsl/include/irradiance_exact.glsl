// E(n) = sum over the texels of a coarse sky cube of L (n.w)+ dw, with exact texel solid angles: no noise.
#include "cube.glsl"

layout(set = 0, binding = 0) uniform samplerCube coarse_radiance; // kcd/m^2
layout(set = 0, binding = 1, scalar) readonly buffer Texels {
    vec4 texels[]; // xyz: direction of the centre; w: solid angle, sr
};

layout(push_constant, scalar) uniform Push {
    uint count; // texels
} push;

/// E, klx; a: 1.
vec4 summed(vec3 n) {
    vec3 total = vec3(0.0);
    for (uint i = 0u; i < push.count; ++i) {
        vec4 texel = texels[i];
        float weight = max(dot(n, texel.xyz), 0.0) * texel.w;
        total += weight * textureLod(coarse_radiance, texel.xyz, 0.0).rgb;
    }
    return vec4(total, 1.0);
}
