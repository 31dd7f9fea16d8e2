#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "materials.glsl"
#include "octahedral.glsl"
#include "gbuffer_push.glsl"
#include "face_slope.glsl"

layout(location = 0) in vec4 surface; // world normal; thickness of the body, metres

layout(location = 0) out uvec4 words; // as of gbuffer.frag
layout(location = 1) out vec4 albedo;

void main() {
    // Surfaces are two-sided. That front faces are on the side of all their normals was seen to when the scene was loaded.
    uint normal = normal_pack(gl_FrontFacing ? surface.xyz : -surface.xyz);
    albedo = vec4(push.diffuse, 1.0);
    // The constant comes back from interpolation with an error in its last bits, of which cutting would make a whole step.
    words = uvec4(normal, material_word(push.material, surface.w * (1.0 + 1e-6)), face_slopes(), 0u);
}
