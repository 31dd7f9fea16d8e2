#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "cube.glsl"

// E(n) = sum over the texels of a coarse sky cube of L (n.w)+ dw, with exact texel solid angles: no noise.

layout(location = 0) in vec2 face_st;
layout(location = 1) flat in int face;
layout(location = 0) out vec4 sum;            // E, klx; a: 1
layout(location = 1) out vec4 sky_irradiance; // E, klx

layout(set = 0, binding = 0) uniform samplerCube coarse_radiance; // kcd/m^2
layout(set = 0, binding = 1, scalar) readonly buffer Texels {
    vec4 texels[]; // xyz: direction of the centre; w: solid angle, sr
};

layout(push_constant, scalar) uniform Push {
    uint count; // texels
} push;

void main() {
    vec3 n = normalize(cube_direction(face, face_st));
    vec3 total = vec3(0.0);
    for (uint i = 0u; i < push.count; ++i) {
        vec4 texel = texels[i];
        float weight = max(dot(n, texel.xyz), 0.0) * texel.w;
        total += weight * textureLod(coarse_radiance, texel.xyz, 0.0).rgb;
    }
    sum = vec4(total, 1.0);
    sky_irradiance = sum;
}
