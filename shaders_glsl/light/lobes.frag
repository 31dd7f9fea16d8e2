#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// CELLS: surfaces that rays meet have light, from the cells.
// Variant: CELLS
#ifdef CELLS
#include "scene_light.glsl"
#include "surface_light.glsl"
#include "cells.glsl"
#include "half_size.glsl"
#else
#include "colour.glsl"
#include "constants.glsl"
#include "frame.glsl"
#include "octahedral.glsl"
#include "random.glsl"
#include "sobol.glsl"
#include "surface_hit.glsl"
#include "occlusion.glsl"
#endif
#include "face.glsl"
#include "materials.glsl"
#include "microfacet.glsl"
#include "filtered.glsl"

// Light of the sky and of surfaces in the lobes of materials that reflect by GGX.
//
// Converging frames trace a ray in a direction of the lobe: their mean is the integral over the lobe. Other frames take the split sum
// (Karis 2013): the reflectance of the lobe times the prefiltered sky, as far as the sky is visible, and the light of the bounces;
// smooth surfaces trace a ray along the mirror direction.

// rgb: kcd/m^2; a: number of the material plus 1, or 0 where there is no lobe.
layout(location = 0) out vec4 light;

layout(constant_id = 0) const bool CONVERGING = false;
layout(constant_id = 1) const bool ALBEDO_IMAGE = true;
// Whether surfaces that rays meet are seen; otherwise they hide the sky.
layout(constant_id = 2) const bool LIT = false;
// As in lighting.frag.
layout(constant_id = 3) const int OCCLUSION_DOWNSCALE = 2;

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform usampler2D normal_material;
layout(set = 0, binding = 2) uniform sampler2D albedo; // with ALBEDO_IMAGE; else any
layout(set = 0, binding = 3) uniform sampler2D materials;
layout(set = 0, binding = 4) uniform samplerCube sky_radiance;   // kcd/m^2, without the discs
layout(set = 0, binding = 5) uniform samplerCube sky_prefiltered; // the same, a mip level for each roughness
layout(set = 0, binding = 6) uniform samplerCube sky_irradiance; // klx
layout(set = 0, binding = 7) uniform usampler2D ambient;  // as in lighting.frag; with CONVERGING any
layout(set = 0, binding = 8) uniform sampler2D previous;  // the light of the frame before
layout(set = 0, binding = 9, scalar) uniform View { VIEW_BLOCK } view;

layout(push_constant, scalar) uniform Push {
    ivec2 origin; // of this picture in the whole one, pixels
    uint index;   // of this frame in the average
    uint seed;    // of the random numbers
} push;

// Frames in which a pixel of a weak lobe traces one ray: its light is held in between.
const uint PERIOD = 8u;
// Pixels of a square that takes its turn: neighbours are computed together.
const int SQUARE = 8;
// Least reflectance of lobes that trace rays in every frame: of rough ones, and of those below a roughness, whose light has edges.
const float STRONG = 0.15, CLEAR = 0.03;
const float CLEAR_ROUGHNESS = 0.4;
// Rays that such a lobe traces in a frame from a roughness on.
const uint RAYS = 4u;
const float SOFT = 0.15;
// Rays that have the same weight as the mean from the cells.
const float EVEN = 12.0;
// Roughnesses between which lobes become wide: single frames fade from the mirror direction to the mean of the lobe.
const float SHARP = 0.25, BLURRED = 0.6;

struct Point {
    vec3 world;
    vec3 toward; // from the eye, unit
    vec3 n;
    vec3 face;
    float distance; // along the view axis, metres
};

/// A direction of light above the face: one below is reflected by the surface once more.
vec3 above(Point p, vec3 l) {
    if (!is_turned_away(p.face, p.n, l)) return l;
    return reflect(l, p.face);
}

/// Radiance along a ray, kcd/m^2: of the surface that it meets, or of the sky.
vec3 seen(Point p, vec3 l, vec3 sky, uint state) {
    vec3 side = dot(p.face, p.n) > SAME_FACE ? p.face : p.n;
    vec3 origin = lifted_from(p.world, side, view.eye, corner_error(view.ray_scale, vec2(textureSize(depth, 0))));
    Hit hit = closest(origin, l, FAR);
    if (hit.distance == FAR) return sky;
    if (!LIT) return vec3(0.0);
#ifdef CELLS
    Surface surface = surface_of(hit, origin, l);
    vec3 sun = sun_irradiance_at(surface.position, surface.normal, vec2(rnd(state), rnd(state)));
    Cached here = cached(surface.position, surface.normal);
    return surface.albedo / PI * (sun + here.sky + here.bounce) + surface.emission;
#else
    return vec3(0.0);
#endif
}

/// The light of a direction of the lobe.
vec3 of_direction(Point p, Microfacet m, uint number, uint seed) {
    mat3 frame = frame_from_normal(p.n);
    vec3 v = -p.toward * frame;
    v = normalize(vec3(v.xy, max(v.z, LEAST_FACING)));
    vec3 h = visible_normal(m.alpha, v, scrambled_sobol(number, seed));
    float along = dot(v, h);
    vec3 l = 2.0 * along * h - v;
    if (l.z <= 0.0) return vec3(0.0);
    vec3 toward = above(p, frame * l);
    return lobe_weight(m, v.z, l.z, along) * seen(p, toward, filtered(sky_radiance, toward, 0.0).rgb, tea(seed, number));
}

/// The sky about a direction, prefiltered for the roughness.
vec3 filtered_sky(vec3 r, float roughness) {
    float level = roughness * float(textureQueryLevels(sky_prefiltered) - 1);
    // The first level is the sky itself, which is finer.
    if (level < 1.0) return mix(filtered(sky_radiance, r, 0.0).rgb, filtered(sky_prefiltered, r, 1.0).rgb, level);
    return filtered(sky_prefiltered, r, level).rgb;
}

/// The open sky in the lobe.
vec3 open_sky(Point p, Microfacet m) {
    // Lagarde and de Rousiers 2014, "Moving Frostbite to PBR": the middle of a rough lobe is nearer the normal than the mirror direction.
    float bent = (1.0 - m.alpha) * (sqrt(1.0 - m.alpha) + m.alpha);
    return filtered_sky(normalize(mix(p.n, reflect(p.toward, p.n), bent)), m.roughness);
}

/// How far a lobe is so wide that the light about the normal stands for that about the mirror direction, 0..1.
float wideness(Microfacet m) {
    return smoothstep(SHARP, BLURRED, m.roughness);
}

#ifdef CELLS
/// Mean radiance in a wide lobe, of the sky as far as it is visible and of the bounces, by the irradiances of both, klx.
vec3 blurred(Point p, vec3 open, vec3 sky, vec3 bounce) {
    float whole = luminance(filtered(sky_irradiance, p.n, 0.0).rgb);
    return open * clamp(luminance(sky) / max(whole, 1e-9), 0.0, 1.0) + bounce / PI;
}
#endif

/// The light of the whole lobe, by the split sum.
vec3 of_lobe(Point p, Microfacet m, ivec2 pixel, uint seed) {
    vec3 open = open_sky(p, m), mean = vec3(0.0);
#ifdef CELLS
    Ambient here = half_size_at(ambient, pixel, ivec2(0), p.distance, p.n);
    mean = blurred(p, open, here.sky, here.bounce);
    float share = 1.0 - wideness(m);
#else
    // Occlusion in screen space knows what is near: what hides the sky from a room, only the ray meets.
    open *= ambient_occlusion(ambient, OCCLUSION_DOWNSCALE, pixel + push.origin, p.distance);
    float share = 1.0;
#endif
    if (share > 0.0) mean = mix(mean, seen(p, above(p, reflect(p.toward, p.n)), open, seed), share);
    return m.reflectance * mean;
}

/// The light of rays in a strong lobe.
vec3 of_rays(Point p, Microfacet m, uint seed) {
    uint count = m.roughness > SOFT ? RAYS : 1u;
    vec3 sum = vec3(0.0);
    for (uint k = 0u; k < count; ++k) sum += of_direction(p, m, count * push.index + k, seed);
    return sum / float(count);
}

/// The light of a ray in a weak lobe. That of a wide one starts with the mean from the cells, which is smooth, and ends with that of the
/// rays, which is exact: over n rays their share is n / (n + EVEN).
vec3 of_rare_rays(Point p, Microfacet m, uint seed) {
    uint number = (push.index + PERIOD - 1u) / PERIOD;
    float share = 1.0;
    vec3 light = vec3(0.0);
#ifdef CELLS
    Cached here = Cached(vec3(0.0), vec3(0.0), false);
    if (m.roughness > SHARP) here = interpolated(p.world, p.n);
    if (here.is_found) {
        float n = float(number);
        share = mix(1.0, n * (n + 2.0 * EVEN) / ((n + EVEN) * (n + EVEN)), wideness(m));
        light = (1.0 - share) * m.reflectance * blurred(p, open_sky(p, m), here.sky, here.bounce);
    }
#endif
    return share > 0.0 ? light + share * of_direction(p, m, number, seed) : light;
}

/// Whether the square of a pixel traces rays in this frame.
bool is_turn(ivec2 whole) {
    uvec2 square = uvec2(whole / SQUARE);
    return push.index == 0u || (square.x + 3u * square.y + push.index) % PERIOD == 0u;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 size = vec2(textureSize(depth, 0)), uv = gl_FragCoord.xy / size;
    float d = textureLod(depth, uv, 0.0).r;
    uvec3 own = textureLod(normal_material, uv, 0.0).xyz;
    light = vec4(0.0);
    // Software devices compute pixels that fail the depth test beside those that pass: a ray from nowhere would meet every node.
    if (d == 0.0 || !is_rough(material_specular(materials, own.y))) return;
    vec3 ray = view_ray(uv, view.ray_scale, view.ray_offset);
    float distance = view.near / d;
    vec3 from_eye = view.world_from_view * (ray * distance);
    vec3 face = view.world_from_view * face_normal(own.z, ray.xy, 0.5 * size / view.ray_scale);
    Point p = Point(view.eye + from_eye, normalize(from_eye), normal_unpack(own.x), face, distance);
    vec4 texel = pixel_albedo(ALBEDO_IMAGE, albedo, materials, own.y, uv);
    Microfacet m = microfacet_of(ALBEDO_IMAGE, texel, materials, own.y, -dot(p.toward, p.n));
    float mark = float(material_of(own.y) + 1u);
    ivec2 whole = pixel + push.origin;
    uint seed = tea(uint(whole.x) | uint(whole.y) << 16, push.seed);
    if (!CONVERGING) {
        light = vec4(of_lobe(p, m, pixel, seed), mark);
        return;
    }
    bool is_strong = luminance(m.reflectance) >= (m.roughness < CLEAR_ROUGHNESS ? CLEAR : STRONG);
    if (!is_strong && !is_turn(whole)) {
        light = textureLod(previous, uv, 0.0);
        if (light.a == mark) return;
    }
    light = vec4(is_strong ? of_rays(p, m, seed) : of_rare_rays(p, m, seed), mark);
}
