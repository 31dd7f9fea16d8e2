#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// ALBEDO: with a render target for rho_d. EMISSION: and one for the factor on L_e. DETAILED: surfaces with alpha test, normal maps or
// vertex colours.
// Variant: ALBEDO
// Variant: ALBEDO EMISSION
// Variant: DETAILED
// Variant: DETAILED ALBEDO
// Variant: DETAILED ALBEDO EMISSION
#include "gbuffer.glsl"
#include "face_of_fragment.glsl"
#include "octahedral.glsl"
#include "smoothness.glsl"

layout(location = 0) in vec3 from_eye;
layout(location = 1) in vec3 shading_normal;
layout(location = 2) in vec2 surface_uv;

// x: world normal, octahedral; y: number of the material, roughness (see materials.glsl); z: slopes of the face, see face.glsl
layout(location = 0) out uvec4 normal_material;
#ifdef ALBEDO
layout(location = 1) out vec4 albedo; // rgb: rho_d; a: factor on rho_s. With GGX, base colour and metalness
#endif
#ifdef EMISSION
layout(location = 2) out vec4 emission; // rgb: factor on L_e

layout(constant_id = 6) const bool EMISSIVE_MAP = true;

layout(set = 0, binding = 4) uniform sampler2D emissive_map;
#endif

layout(constant_id = 0) const bool DIFFUSE_MAP = true;
layout(constant_id = 1) const bool SPECULAR_MAP = true;
layout(constant_id = 3) const bool CUT_OUT = true;
// All normals are on the side of their front faces, as checked when the scene was loaded.
layout(constant_id = 4) const bool NORMALS_MATCH_WINDING = false;
// Whether the G-buffer stores the slopes of faces.
layout(constant_id = 5) const bool FACES = false;

layout(set = 0, binding = 1) uniform sampler2D diffuse_map;
layout(set = 0, binding = 2) uniform sampler2D specular_map;

#ifdef DETAILED
layout(constant_id = 2) const bool NORMAL_MAP = true;

layout(set = 0, binding = 3) uniform sampler2D normal_map;

layout(location = 3) in vec4 surface_colour;  // linear RGBA
layout(location = 4) in vec4 surface_tangent; // w: sign of the bitangent

/// The map's normal in the tangent frame of the surface (Mikkelsen 2008: interpolated, not normalized).
vec3 mapped_normal(vec3 n) {
    vec3 slope = texture(normal_map, surface_uv, -camera.sharpen).xyz * 2.0 - 1.0;
    slope.xy *= push.normal_scale;
    vec3 bitangent = cross(shading_normal, surface_tangent.xyz) * surface_tangent.w;
    return slope.x * surface_tangent.xyz + slope.y * bitangent + slope.z * n;
}

/// Adjusts a mapped normal so that the reflected view ray points above the surface. A ray reflected into the surface would hit it
/// again and be reflected upward; without this, distant waves would reflect the ground below the horizon.
vec3 reflecting_up(vec3 mapped, vec3 n) {
    vec3 toward = normalize(from_eye);
    vec3 r = reflect(toward, normalize(mapped));
    float below = dot(r, normalize(n));
    return below < 0.0 ? r - 2.0 * below * normalize(n) - toward : mapped;
}
#endif

void main() {
    vec3 n;
    if (NORMALS_MATCH_WINDING) n = gl_FrontFacing ? shading_normal : -shading_normal;
    else n = facing_normal(shading_normal, from_eye, CUT_OUT ? CUT_OUT_SLACK : 0.0);
    vec4 diffuse = vec4(push.diffuse, 1.0);
#ifdef DETAILED
    diffuse *= surface_colour;
    if (NORMAL_MAP) {
        vec3 mapped = mapped_normal(n);
        n = push.is_specular != 0u ? reflecting_up(mapped, n) : mapped;
    }
#endif
    if (DIFFUSE_MAP) diffuse *= texture(diffuse_map, surface_uv, -camera.sharpen);
    uint smoothness = 0u;
#ifdef ALBEDO
    bool is_rough = push.metallic >= 0.0;
    float gloss = is_rough ? push.metallic : 1.0;
    if (SPECULAR_MAP) {
        vec3 texel = texture(specular_map, surface_uv, -camera.sharpen).rgb;
        if (is_rough) smoothness = smoothness_pack(texel.g);
        gloss = is_rough ? gloss * texel.b : dot(texel, vec3(1.0 / 3.0));
    }
    albedo = vec4(diffuse.rgb, gloss);
#endif
#ifdef EMISSION
    emission = vec4(1.0);
    if (EMISSIVE_MAP) emission = texture(emissive_map, surface_uv, -camera.sharpen);
#endif
    if (CUT_OUT && diffuse.a < push.cutoff) discard;
    normal_material = uvec4(normal_pack(n), push.material | smoothness, FACES ? face_slopes() : 0u, 0u);
}
