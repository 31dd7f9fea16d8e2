#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "octahedral.glsl"
#include "facing.glsl"
#include "materials.glsl"
#include "gbuffer_push.glsl"
#include "face_slope.glsl"

layout(location = 0) in vec3 from_eye;
layout(location = 1) in vec3 shading_normal;
layout(location = 2) in vec2 surface_uv;
layout(location = 3) flat in float thickness; // behind the surface, metres

// x: world normal, octahedral; y: lower half: column of the table of materials; upper: of the thickness' bits; z: the face's slopes
layout(location = 0) out uvec4 words;
layout(location = 1) out vec4 albedo;   // rgb: rho_d; a: factor on rho_s. Scenes without maps have it in the table only

layout(constant_id = 0) const bool DIFFUSE_MAP = true;
layout(constant_id = 1) const bool SPECULAR_MAP = true;

layout(set = 0, binding = 0) uniform sampler2D diffuse_map;
layout(set = 0, binding = 1) uniform sampler2D specular_map;

void main() {
    uint normal = normal_pack(facing_normal(shading_normal, from_eye, 0.0));
    albedo = vec4(push.diffuse, 1.0);
    if (DIFFUSE_MAP) albedo.rgb *= texture(diffuse_map, surface_uv, -push.sharpen).rgb;
    if (SPECULAR_MAP) albedo.a = dot(texture(specular_map, surface_uv, -push.sharpen).rgb, vec3(1.0 / 3.0));
    words = uvec4(normal, material_word(push.material, thickness), face_slopes(), 0u);
}
