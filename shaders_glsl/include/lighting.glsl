#include "air.glsl"
#include "bvh.glsl"
#include "colour.glsl"
#include "constants.glsl"
#include "materials.glsl"
#include "microfacet.glsl"
#include "occlusion.glsl"
#include "octahedral.glsl"
#include "half_size.glsl"
#include "phong.glsl"
#include "face.glsl"
#include "panes.glsl"

// T (L_e + L_sun + L_sky + L_bounces) + L_air. With CELLS the irradiances of sky and bounces are those of the cells. Otherwise it is the lecture's
// slide "Illumination model for skylight":
//   L_r = rho_d/pi ((n.l) V E_sun + A E_sky(n)) + rho_s ((r.l)^p V E_sun + L_sky(r))

// Terms of the sum.
layout(constant_id = 51) const bool TRACES = false; // rays decide at the edges of shadows
layout(constant_id = 0) const bool SUN = true;
layout(constant_id = 1) const bool SKY = true;
layout(constant_id = 2) const bool SUN_SPECULAR = true;
layout(constant_id = 3) const bool SKY_SPECULAR = true;
// What panes of glass mirror is shown.
layout(constant_id = 27) const bool MIRRORED = true;
// One of these quantities instead of the sum.
layout(constant_id = 4) const bool SHOW_VISIBILITY = false;
layout(constant_id = 5) const bool SHOW_OCCLUSION = false;
layout(constant_id = 6) const bool SHOW_IRRADIANCE = false;
layout(constant_id = 7) const bool SHOW_ALBEDO = false;
layout(constant_id = 8) const bool SHOW_NORMAL = false;
layout(constant_id = 9) const bool SHOW_DEPTH = false;
// Pixels per texel of the occlusion, along each axis.
layout(constant_id = 10) const int OCCLUSION_DOWNSCALE = 2;
// rho_s grows toward grazing angles.
layout(constant_id = 11) const bool FRESNEL = false;
// Includes diffuse sky light; otherwise the dome adds it (A = 0 here).
layout(constant_id = 12) const bool AMBIENT = true;
// A single shadow comparison in the plane of the face, for averaged frames, whose mean softens the edges.
layout(constant_id = 13) const bool PLANE_SHADOW = false;
// With PLANE_SHADOW: rays find what is before the sun; the map holds cut-outs alone, if there are any.
layout(constant_id = 52) const bool SUN_BY_RAYS = false;
layout(constant_id = 53) const bool CUT_OUTS = false;
// rho_d is stored per pixel; otherwise the scene has no maps, and rho_d is in the table of materials.
layout(constant_id = 14) const bool ALBEDO_IMAGE = true;
// Number of the sun's shadow maps, side by side.
layout(constant_id = 15) const int CASCADES = 1;
// Penumbrae of physical width, from the sun's angular radius.
layout(constant_id = 16) const bool PCSS = false;
// The light of the sky and of other surfaces is in the cells; otherwise it is A E_sky.
layout(constant_id = 21) const bool CELLS = false;
layout(constant_id = 22) const bool BOUNCES = true;
// L_e of surfaces, from the table of materials; with EMISSION_IMAGE times a factor per pixel.
layout(constant_id = 23) const bool EMISSION = false;
layout(constant_id = 24) const bool EMISSION_IMAGE = false;
// The air dims the surface, and adds the light that it scatters.
layout(constant_id = 25) const bool AIR = false;
layout(constant_id = 26) const bool INSCATTER = true;
// Energy-conserving specular lobe for both sun and sky.
layout(constant_id = 17) const bool NORMALIZED = false;
// Light of sky and surfaces in the lobes of GGX.
layout(constant_id = 28) const bool LOBES = false;

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform usampler2D normal_material;
layout(set = 0, binding = 2) uniform sampler2D albedo;      // with ALBEDO_IMAGE; else any
layout(set = 0, binding = 3) uniform usampler2D ambient; // see occlusion.glsl; with CELLS, half_size.glsl
layout(set = 0, binding = 4) uniform sampler2D shadow_map; // reversed: 1 is nearest the sun
layout(set = 0, binding = 5) uniform samplerCube sky_irradiance; // E, klx
layout(set = 0, binding = 6) uniform samplerCube sky_radiance;   // L, kcd/m^2, without the disc
layout(set = 0, binding = 7, scalar) uniform View { VIEW_BLOCK } view;
layout(set = 0, binding = 8, scalar) uniform Sun {
    mat4 shadow_from_world;
    vec3 direction;       // unit, toward the sun
    vec3 illuminance;     // E_sun at normal incidence, klx
    float depth_bias;     // of comparisons with PLANE_SHADOW
    float max_radiance;   // largest value the target can represent, kcd/m^2
    float specular_scale; // factor on every rho_s
    mat4 planes;          // inverse transpose of shadow_from_world
    ivec2 occlusion_from; // origin of this picture in the occlusion's picture, pixels
} sun;

layout(set = 0, binding = 9) uniform sampler2D materials; // see materials.glsl
layout(set = 0, binding = 10) uniform sampler2D emission;  // with EMISSION_IMAGE; else any

// What panes of glass let through of the sun's light: rgb: products, a: depth of the pane nearest the sun; with PANES, else any.
layout(set = 0, binding = 28) uniform sampler2D sun_glass;

// With LOBES, see lobes.glsl; else any.
layout(set = 0, binding = 30) uniform sampler2D lobes; // kcd/m^2

#include "sun_shadow.glsl"

/// V of one point of the sun's disc. Where the texels around it do not agree, a ray decides: the edge of a wall is within a texel.
float plane_visibility(vec3 world, vec3 n, vec3 face) {
    if (is_turned_away(face, n, sun.direction)) return 0.0;
    vec4 window = vec4(vec2(0.0), vec2(textureSize(shadow_map, 0)));
    float error = corner_error(view.ray_scale, vec2(textureSize(depth, 0)));
    if (SUN_BY_RAYS) {
        if (CUT_OUTS && !is_lit_in_plane(shadow_map, sun.shadow_from_world, sun.planes, window, sun.depth_bias, world, face)) return 0.0;
        vec3 origin = lifted_toward(world, face, sun.direction, view.eye, error);
        return float(traced(origin, sun.direction, FAR, true, OPAQUE_ONLY).distance == FAR);
    }
    LitInPlane lit = lit_in_plane(shadow_map, sun.shadow_from_world, sun.planes, window, sun.depth_bias, world, face);
    if (!lit.is_edge || dot(face, sun.direction) <= 0.0) return float(lit.is_lit);
    // Rays do not know the holes of cut-outs: they overrule the map only where those do not count.
    vec3 origin = lifted_to_eye(world, face, view.eye, error);
    bool is_stopped = traced(origin, sun.direction, FAR, true, lit.is_lit ? OPAQUE_ONLY : CUT_OUTS_BLOCK).distance < FAR;
    return float(!is_stopped);
}

/// What panes let through of the light of one point of the sun's disc.
vec3 plane_tint(vec3 world) {
    vec4 c = sun.shadow_from_world * vec4(world, 1.0);
    vec3 p = c.xyz / c.w;
    int edge = textureSize(sun_glass, 0).y;
    return glass_at((p.xy * 0.5 + 0.5) * float(edge), p.z, 0, edge);
}

/// The light of a pixel with a surface; `at`: its centre. rgb: kcd/m^2, or the quantity shown; a: illuminance of the surface, klx.
vec4 lit(vec2 at) {
    ivec2 pixel = ivec2(at);
    vec2 uv = at / vec2(textureSize(depth, 0));
    float d = textureLod(depth, uv, 0.0).r;
    vec3 ray = view_ray(uv, view.ray_scale, view.ray_offset);
    vec3 world_ray = view.world_from_view * ray;
    // Only pixels with a surface come here: d > 0.
    float distance = view.near / d;
    vec3 world = view.eye + world_ray * distance;
    uvec3 own = textureLod(normal_material, uv, 0.0).xyz;
    vec3 n = normal_unpack(own.x);
    uint material = own.y;
    vec4 surface = pixel_albedo(ALBEDO_IMAGE, albedo, materials, material, uv);
    vec4 specular = vec4(0.0);
    if (SUN_SPECULAR || SKY_SPECULAR || ROUGH) specular = material_specular(materials, material);
    bool rough = is_rough(specular);
    vec3 toward = normalize(world_ray);
    Microfacet facets;
    vec3 rho_d = surface.rgb;
    if (rough) {
        facets = microfacet_of(ALBEDO_IMAGE, surface, materials, material, -dot(toward, n));
        rho_d = under_lobe(facets);
    }
    float n_dot_l = dot(n, sun.direction);

    float V = 0.0;
    // A software device also shades pixels that the depth test drops: theirs is no place for a ray to start.
    if (n_dot_l > 0.0 && d > 0.0) {
        if (PLANE_SHADOW) V = plane_visibility(world, n, view.world_from_view * face_normal(own.z, ray.xy, 0.5 * vec2(textureSize(depth, 0)) / view.ray_scale));
        else V = sun_visibility(world, n, n_dot_l, TRACES);
    }
    float A = 0.0;
    Ambient light = Ambient(vec3(0.0), vec3(0.0));
    if (AMBIENT && CELLS) {
        light = half_size_at(ambient, pixel, ivec2(0), distance, n);
        if (SHOW_OCCLUSION) A = luminance(light.sky) / max(luminance(filtered(sky_irradiance, n, 0.0).rgb), 1e-9);
    } else if (AMBIENT) {
        A = ambient_occlusion(ambient, OCCLUSION_DOWNSCALE, pixel + sun.occlusion_from, distance);
        light.sky = A * filtered(sky_irradiance, n, 0.0).rgb;
    }
    vec3 sun_illuminance = sun.illuminance;
    if (PANES && V > 0.0) sun_illuminance *= PLANE_SHADOW ? plane_tint(world) : sun_tint(world);
    vec3 sun_irradiance = max(n_dot_l, 0.0) * V * sun_illuminance;
    vec3 irradiance = light.sky + light.bounce;

    float illuminance = luminance(sun_irradiance + irradiance);
    if (SHOW_VISIBILITY) return vec4(vec3(V), illuminance);
    if (SHOW_OCCLUSION) return vec4(vec3(A), illuminance);
    if (SHOW_IRRADIANCE) return vec4(sun_irradiance + irradiance, illuminance);
    if (SHOW_ALBEDO) return vec4(rough ? facets.diffuse : surface.rgb, illuminance);
    if (SHOW_NORMAL) return vec4(n, illuminance);
    if (SHOW_DEPTH) return vec4(vec3(distance), illuminance);

    vec3 sum = vec3(0.0);
    if (SUN) sum += rho_d / PI * sun_irradiance;
    if (SKY) sum += rho_d / PI * light.sky;
    if (BOUNCES) sum += rho_d / PI * light.bounce;
    if (EMISSION) {
        vec3 emitted = material_emission(materials, material);
        if (EMISSION_IMAGE) emitted *= textureLod(emission, uv, 0.0).rgb;
        sum += emitted;
    }
    if (rough) {
        if (SUN_SPECULAR && V > 0.0) sum += lobe_toward(facets, n, -toward, sun.direction) * V * sun_illuminance;
        if (LOBES) sum += textureLod(lobes, uv, 0.0).rgb;
    } else if (SUN_SPECULAR || SKY_SPECULAR) {
        vec4 m = specular;
        vec3 rho_s = m.rgb * (surface.a * sun.specular_scale);
        if (FRESNEL && any(greaterThan(rho_s, vec3(0.0)))) rho_s = grazing(rho_s, m.a, -dot(toward, n));
        vec3 r = reflect(toward, n);
        float r_dot_l = max(dot(r, sun.direction), 0.0);
        float lobe = pow(r_dot_l, m.a);
        if (NORMALIZED) lobe *= phong_scale(m.a) * max(n_dot_l, 0.0);
        if (SUN_SPECULAR) sum += rho_s * (lobe * V) * sun_illuminance;
        if (SKY_SPECULAR && NORMALIZED) sum += rho_s * sky_in_lobe(sky_radiance, r, n, m.a, vec2(0.0));
        else if (SKY_SPECULAR) sum += rho_s * filtered(sky_radiance, r, 0.0).rgb;
    }
    if (AIR) {
        AirRay through = air_ray(toward, distance * length(world_ray) * 1e-3);
        sum *= air_transmittance(through);
        if (INSCATTER) sum += air_inscatter(through, toward);
    }
    if (PANES) {
        sum *= through_panes(pixel);
        if (MIRRORED) sum += mirrored_by_panes(pixel);
    }
    return vec4(min(sum, sun.max_radiance), illuminance);
}
