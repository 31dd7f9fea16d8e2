#include "air.glsl"
#include "colour.glsl"
#include "constants.glsl"
#include "dome.glsl"
#include "materials.glsl"
#include "microfacet.glsl"
#include "octahedral.glsl"
#include "half_size.glsl"
#include "panes.glsl"

// Sky light by shadow maps from sampled directions: E = 1/n sum V (n.w) L/p, and the same without V. Both are averaged over
// the frames, as is all other light; their quotient is the light-weighted A.

// The result for a pixel.
// rgb: reflected sky light; a: its luminance without occlusion, from the same directions.
vec4 sky;
// rgb: all other light, kcd/m^2; a: the luminance of the unoccluded sky light, from the irradiance cube.
vec4 rest;

#ifdef ILLUMINANCE
// Illuminance of the surface, klx. x: from the sky; y: from the unoccluded sky, same directions; z: from the unoccluded sky,
// irradiance cube; w: from the sun and other surfaces.
vec4 illuminance;
layout(set = 0, binding = 11) uniform sampler2D previous_illuminance;
#endif

// The quantity shown for sky light: irradiance, A, or (neither) the reflected radiance.
layout(constant_id = 0) const bool SHOW_IRRADIANCE = false;
layout(constant_id = 1) const bool SHOW_OCCLUSION = false;
// Whether sky light is shown at all.
layout(constant_id = 2) const bool SKY = true;
layout(constant_id = 3) const int DIRECTIONS = 4;
// As in lighting.glsl.
layout(constant_id = 4) const bool ALBEDO_IMAGE = true;
// Whether there is light from other surfaces, and whether it is shown.
layout(constant_id = 5) const bool BOUNCES = false;
layout(constant_id = 6) const bool SHOW_BOUNCES = false;

// Whether the air dims the surface.
layout(constant_id = 7) const bool AIR = false;

// Rays have told which directions are visible.
layout(constant_id = 8) const bool RAYS = false;

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform usampler2D normal_material;
layout(set = 0, binding = 2) uniform sampler2D albedo;         // with ALBEDO_IMAGE; else any
layout(set = 0, binding = 3) uniform sampler2D frame;          // kcd/m^2, without sky light; a: illuminance from the sun, klx
layout(set = 0, binding = 4) uniform sampler2D previous_sky;
layout(set = 0, binding = 5) uniform sampler2D previous_rest;
layout(set = 0, binding = 7) uniform samplerCube sky_irradiance; // E of sky and ground, klx
layout(set = 0, binding = 8, scalar) uniform View { VIEW_BLOCK } view;
layout(set = 0, binding = 10) uniform sampler2D materials; // see materials.glsl
layout(set = 0, binding = 12) uniform usampler2D bounced; // with BOUNCES: irradiance from other surfaces, see half_size.glsl; else any

layout(set = 0, binding = 15) uniform sampler2D sky_light; // with RAYS, see dome_rays.comp; else any

layout(push_constant, scalar) uniform Push {
    vec3 ground; // radiance below the horizon, kcd/m^2
    float share; // of this frame in the means, 0..1
    ivec2 chosen; // pixel of each square of two by two that has a texel of `bounced`
} push;

bool is_reached(int k, vec3 world, vec3 n, vec3 face) {
    return is_lit_from(k, world, n, face);
}

#include "dome_light.glsl"

/// Adds the light of the sky at a surface; `reflected`: the fraction of irradiance that is shown.
void gather(vec2 uv, float d, uvec3 own, vec3 reflected) {
    vec3 ray = view_ray(uv, view.ray_scale, view.ray_offset);
    vec3 n = normal_unpack(own.x);
    vec3 world = view.eye + view.world_from_view * (ray * (view.near / d));
    if (RAYS) sky = textureLod(sky_light, uv, 0.0);
    else sky = light_of_directions(world, n, view.world_from_view * face_normal(own.z, ray.xy, 0.5 * vec2(textureSize(depth, 0)) / view.ray_scale), push.ground);
    vec3 open = filtered(sky_irradiance, n, 0.0).rgb;
#ifdef ILLUMINANCE
    illuminance.xyz = vec3(luminance(sky.rgb), sky.a, luminance(open));
    if (!SKY) {
        sky = vec4(0.0);
        return;
    }
#endif
    if (SHOW_OCCLUSION) {
        sky.rgb = vec3(luminance(sky.rgb));
        rest.a = 1.0;
        return;
    }
    sky *= vec4(reflected, luminance(reflected));
    rest.a = luminance(open) * luminance(reflected);
}

/// rho_d of a pixel.
vec3 diffuse_at(vec2 uv, uvec3 own) {
    vec4 texel = pixel_albedo(ALBEDO_IMAGE, albedo, materials, own.y, uv);
    if (!ROUGH) return texel.rgb;
    vec3 toward = normalize(view.world_from_view * view_ray(uv, view.ray_scale, view.ray_offset));
    return pixel_diffuse(ALBEDO_IMAGE, texel, materials, own.y, -dot(toward, normal_unpack(own.x)));
}

/// The means with this frame; `at`: the pixel's centre.
void gather_at(vec2 at) {
    vec2 uv = at / vec2(textureSize(depth, 0));
    float d = textureLod(depth, uv, 0.0).r;
    sky = vec4(0.0);
    vec4 lit = textureLod(frame, uv, 0.0);
    rest = vec4(lit.rgb, 0.0);
    if (d > 0.0) {
        uvec3 own = textureLod(normal_material, uv, 0.0).xyz;
        vec3 reflected = vec3(1.0);
        if (!SHOW_IRRADIANCE) reflected = through_panes(ivec2(at)) * diffuse_at(uv, own) / PI;
        if (AIR) {
            vec3 toward = view.world_from_view * view_ray(uv, view.ray_scale, view.ray_offset) * (view.near / d);
            reflected *= air_transmittance(air_ray(normalize(toward), length(toward) * 1e-3));
        }
#ifdef ILLUMINANCE
        illuminance = vec4(0.0, 0.0, 0.0, lit.a);
        gather(uv, d, own, reflected);
#else
        if (SKY) gather(uv, d, own, reflected);
#endif
        if (BOUNCES) {
            vec3 bounce = half_size_at(bounced, ivec2(at), push.chosen, view.near / d, normal_unpack(own.x)).bounce;
#ifdef ILLUMINANCE
            illuminance.w += luminance(bounce);
#endif
            if (SHOW_BOUNCES) rest.rgb += reflected * bounce;
        }
    }
#ifdef ILLUMINANCE
    else illuminance = vec4(0.0, 0.0, 0.0, lit.a);
#endif
    if (push.share >= 1.0) return;
    sky = mix(textureLod(previous_sky, uv, 0.0), sky, push.share);
    rest = mix(textureLod(previous_rest, uv, 0.0), rest, push.share);
#ifdef ILLUMINANCE
    illuminance = mix(textureLod(previous_illuminance, uv, 0.0), illuminance, push.share);
#endif
}
