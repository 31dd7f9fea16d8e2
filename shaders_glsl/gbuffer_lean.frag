#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "octahedral.glsl"
#include "gbuffer_push.glsl"

layout(location = 0) in vec4 surface; // world normal; thickness of the body, metres

layout(location = 0) out uint normal;   // as of gbuffer.frag
layout(location = 1) out uint material;
layout(location = 2) out vec4 albedo;

void main() {
    // Surfaces are two-sided. That front faces are on the side of all their normals was seen to when the scene was loaded.
    normal = normal_pack(gl_FrontFacing ? surface.xyz : -surface.xyz);
    albedo = vec4(push.diffuse, 1.0);
    // Rounded: the constant that is interpolated comes back with an error in its last bits.
    material = push.material | ((floatBitsToUint(surface.w) + 0x8000u) & 0xffff0000u);
}
