#include "air.glsl"
#include "colour.glsl"
#include "constants.glsl"
#include "dome.glsl"
#include "materials.glsl"
#include "octahedral.glsl"
#include "panes.glsl"
#include "phong.glsl"

// Specular reflection of the sky with visibility, rho_s V(x, r) L_sky(r) of the lecture's rendering equation: the reflection of
// the unoccluded sky, and V, the visible fraction of the light in the lobe around r, from the directions of all frames so far.
// Each direction is weighted by (r.w)^p: the more directions there are, the closer to r those with most of the weight.

// The result for a pixel.
// rgb: reflection of the unoccluded sky, kcd/m^2; a: visible light of the directions in the lobe.
vec4 reflected;
// All light of the directions in the lobe.
float lobe;

layout(constant_id = 0) const int DIRECTIONS = 4;
layout(constant_id = 1) const bool FRESNEL = false;
// Energy-conserving lobe, which blurs the sky; otherwise the lecture's perfect mirror.
layout(constant_id = 2) const bool NORMALIZED = false;
// As in lighting.glsl.
layout(constant_id = 3) const bool ALBEDO_IMAGE = true;

layout(constant_id = 4) const bool AIR = false;

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform usampler2D normal_material;
layout(set = 0, binding = 2) uniform sampler2D albedo;         // with ALBEDO_IMAGE; else any
layout(set = 0, binding = 3) uniform sampler2D previous_reflected;
layout(set = 0, binding = 4) uniform sampler2D previous_lobe;
layout(set = 0, binding = 5) uniform samplerCube sky_radiance; // L, kcd/m^2, without the disc
layout(set = 0, binding = 7) uniform sampler2D materials;      // see materials.glsl
layout(set = 0, binding = 8, scalar) uniform View { VIEW_BLOCK } view;

layout(push_constant, scalar) uniform Push {
    vec2 shift;           // of the lobe's samples, 0..1
    float share;          // of this frame in the means
    float specular_scale; // factor on every rho_s
} push;

// Largest exponent: in a lobe narrower than the spacing of the directions only the nearest one would count.
const float MAX_EXPONENT = 256.0;

void gather(vec2 at, vec2 uv, float d) {
    vec3 ray = view_ray(uv, view.ray_scale, view.ray_offset);
    uvec3 own = textureLod(normal_material, uv, 0.0).xyz;
    vec4 m = material_specular(materials, own.y);
    if (m.a < 0.0) return; // GGX, see lobes.glsl
    vec3 rho_s = m.rgb * (pixel_albedo(ALBEDO_IMAGE, albedo, materials, own.y, uv).a * push.specular_scale);
    if (all(lessThanEqual(rho_s, vec3(0.0)))) return;
    vec3 n = normal_unpack(own.x);
    vec3 toward = view.world_from_view * (ray * (view.near / d));
    vec3 world = view.eye + toward;
    float away = length(toward);
    toward /= away;
    if (FRESNEL) rho_s = grazing(rho_s, m.a, -dot(toward, n));
    rho_s *= through_panes(ivec2(at));
    vec3 r = reflect(toward, n);
    reflected.rgb = rho_s * (NORMALIZED ? sky_in_lobe(sky_radiance, r, n, m.a, push.shift)
                                     : filtered(sky_radiance, r, 0.0).rgb);
    if (AIR) reflected.rgb *= air_transmittance(air_ray(toward, away * 1e-3));
    vec3 face = view.world_from_view * face_normal(own.z, ray.xy, 0.5 * vec2(textureSize(depth, 0)) / view.ray_scale);
    float p = clamp(m.a, 1.0, MAX_EXPONENT);
    for (int k = 0; k < DIRECTIONS; ++k) {
        vec3 w = dome.toward[k].xyz;
        float cosine = dot(n, w);
        float along_r = dot(r, w);
        if (along_r <= 0.0 || cosine <= 0.0) continue;
        float light = pow(along_r, p) * luminance(dome.light[k].rgb);
        if (NORMALIZED) light *= cosine;
        lobe += light;
        if (is_lit_from(k, world, n, face)) reflected.a += light;
    }
}

/// The means with this frame; `at`: the pixel's centre.
void reflect_at(vec2 at) {
    vec2 uv = at / vec2(textureSize(depth, 0));
    float d = textureLod(depth, uv, 0.0).r;
    reflected = vec4(0.0);
    lobe = 0.0;
    if (d > 0.0) gather(at, uv, d);
    if (push.share >= 1.0) return;
    reflected = mix(textureLod(previous_reflected, uv, 0.0), reflected, push.share);
    lobe = mix(textureLod(previous_lobe, uv, 0.0).r, lobe, push.share);
}
