#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "octahedral.glsl"
#include "facing.glsl"
#include "materials.glsl"
#include "gbuffer_push.glsl"
#include "face_slope.glsl"

// As gbuffer.frag, for surfaces with holes, normal maps or colours at their vertices.

layout(location = 0) in vec3 from_eye;
layout(location = 1) in vec3 shading_normal;
layout(location = 2) in vec2 surface_uv;
layout(location = 3) in vec4 surface_colour;  // linear RGBA
layout(location = 4) in vec4 surface_tangent; // w: sign of the bitangent
layout(location = 5) flat in float thickness; // behind the surface, metres

// x: world normal, octahedral; y: lower half: column of the table of materials; upper: of the thickness' bits; z: the face's slopes
layout(location = 0) out uvec4 words;
layout(location = 1) out vec4 albedo;   // rgb: rho_d; a: factor on rho_s

layout(constant_id = 0) const bool DIFFUSE_MAP = true;
layout(constant_id = 1) const bool SPECULAR_MAP = true;
layout(constant_id = 2) const bool NORMAL_MAP = true;
layout(constant_id = 3) const bool CUT_OUT = true;

layout(set = 0, binding = 0) uniform sampler2D diffuse_map;
layout(set = 0, binding = 1) uniform sampler2D specular_map;
layout(set = 0, binding = 2) uniform sampler2D normal_map;

/// The normal of the map in the frame of the surface (Mikkelsen 2008: interpolated, not normalised).
vec3 mapped_normal(vec3 n) {
    vec3 slope = texture(normal_map, surface_uv, -push.sharpen).xyz * 2.0 - 1.0;
    slope.xy *= push.normal_scale;
    vec3 bitangent = cross(shading_normal, surface_tangent.xyz) * surface_tangent.w;
    return slope.x * surface_tangent.xyz + slope.y * bitangent + slope.z * n;
}

/// Where a normal of the map mirrors the view into the surface, what is mirrored there is more of the surface, which mirrors
/// once more: the ray is turned back up. Without that, waves far away would mirror the ground below the horizon.
vec3 mirroring_up(vec3 mapped, vec3 n) {
    vec3 toward = normalize(from_eye);
    vec3 r = reflect(toward, normalize(mapped));
    float below = dot(r, normalize(n));
    return below < 0.0 ? r - 2.0 * below * normalize(n) - toward : mapped;
}

void main() {
    // Cards of leaves and grass lean their normals out of the crown or up: across the face is no reason to turn them.
    vec3 n = facing_normal(shading_normal, from_eye, CUT_OUT ? 0.5 : 0.0);
    vec4 surface = vec4(push.diffuse, 1.0) * surface_colour;
    if (DIFFUSE_MAP) surface *= texture(diffuse_map, surface_uv, -push.sharpen);
    if (NORMAL_MAP) {
        vec3 mapped = mapped_normal(n);
        n = push.mirrors != 0u ? mirroring_up(mapped, n) : mapped;
    }
    float gloss = 1.0;
    if (SPECULAR_MAP) gloss = dot(texture(specular_map, surface_uv, -push.sharpen).rgb, vec3(1.0 / 3.0));
    if (CUT_OUT && surface.a < push.cutoff) discard;
    albedo = vec4(surface.rgb, gloss);
    words = uvec4(normal_pack(n), material_word(push.material, thickness), face_slopes(), 0u);
}
