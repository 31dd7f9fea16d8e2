#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// What gbuffer.frag writes for surfaces without maps, from the number of the triangle at each pixel (Burns & Hunt 2013, "The Visibility
// Buffer"). ALBEDO, EMISSION: as in gbuffer.frag.
// Variant: ALBEDO
// Variant: ALBEDO EMISSION
#include "face.glsl"
#include "facing.glsl"
#include "fullscreen_compute.glsl"
#include "materials.glsl"
#include "octahedral.glsl"

// Whether the slopes of faces are stored.
layout(constant_id = 0) const bool FACES = false;

layout(set = 0, binding = 0) uniform usampler2D triangles; // from 1 on; 0: none
layout(set = 0, binding = 1, scalar) uniform View { VIEW_BLOCK } view;
layout(set = 0, binding = 2) uniform sampler2D materials;

// The scene; three indices a triangle.
layout(set = 0, binding = 3, scalar) readonly buffer Indices { uint indices[]; };
layout(set = 0, binding = 4, scalar) readonly buffer Positions { vec3 positions[]; };
layout(set = 0, binding = 5, scalar) readonly buffer Normals { vec3 normals[]; };
layout(set = 0, binding = 6, scalar) readonly buffer MaterialNumbers { uint material_numbers[]; }; // of each triangle

// See gbuffer.frag.
layout(set = 0, binding = 40, rgba32ui) uniform writeonly uimage2DArray normal_material;
#ifdef ALBEDO
layout(set = 0, binding = 41, rgba16f) uniform writeonly image2DArray albedo;
#endif
#ifdef EMISSION
layout(set = 0, binding = 42, rgba16f) uniform writeonly image2DArray emission;
#endif

/// Weights of the second and third corner where a ray from the origin meets a triangle (Moeller & Trumbore 1997). A pixel's centre may lie
/// beyond the edge by the grid to which a rasteriser rounds the corners.
vec2 weights(vec3 a, vec3 edge1, vec3 edge2, vec3 toward) {
    vec3 p = cross(toward, edge2), q = cross(edge1, a);
    float volume = dot(edge1, p);
    if (volume == 0.0) return vec2(1.0 / 3.0);
    vec2 w = vec2(-dot(a, p), dot(toward, q)) / volume;
    w.x = clamp(w.x, 0.0, 1.0);
    return vec2(w.x, clamp(w.y, 0.0, 1.0 - w.x));
}

/// Relative change of depth from pixel to pixel on a face (view space) at a ray.
vec2 slopes_of(vec3 face, vec3 ray, vec2 size) {
    return face.xy / dot(face, ray) * 2.0 * view.ray_scale / size;
}

/// The words of the G-buffer for a triangle at a pixel.
uvec4 surface(uint triangle, vec2 size) {
    uvec3 corner = uvec3(indices[3u * triangle], indices[3u * triangle + 1u], indices[3u * triangle + 2u]);
    vec3 a = positions[corner.x] - view.eye;
    vec3 edge1 = positions[corner.y] - positions[corner.x], edge2 = positions[corner.z] - positions[corner.x];
    vec3 ray = view_ray(pixel_centre() / size, view.ray_scale, view.ray_offset);
    vec3 toward = view.world_from_view * ray;
    vec2 w = weights(a, edge1, edge2, toward);
    vec3 shading = (1.0 - w.x - w.y) * normals[corner.x] + w.x * normals[corner.y] + w.y * normals[corner.z];
    vec3 face = cross(edge1, edge2);
    face *= dot(face, toward) > 0.0 ? -1.0 : 1.0;
    uint slopes = FACES ? slopes_pack(slopes_of(face * view.world_from_view, ray, size)) : 0u;
    return uvec4(normal_pack(facing(shading, face, 0.0)), material_numbers[triangle], slopes, 0u);
}

void main() {
    ivec2 size = imageSize(normal_material).xy;
    if (!is_pixel_of(size)) return;
    uint triangle = texel_at(triangles, vec2(own_pixel())).r;
    uvec4 words = uvec4(0u);
    if (triangle > 0u) words = surface(triangle - 1u, vec2(size));
    imageStore(normal_material, own_texel(), words);
#ifdef ALBEDO
    vec4 reflected = vec4(0.0);
    if (triangle > 0u) {
        bool is_rough = material_specular(materials, words.y).a < 0.0;
        reflected = vec4(material_row(materials, words.y, 0u).rgb, is_rough ? material_row(materials, words.y, 2u).a : 1.0);
    }
    imageStore(albedo, own_texel(), reflected);
#endif
#ifdef EMISSION
    imageStore(emission, own_texel(), vec4(triangle > 0u ? 1.0 : 0.0));
#endif
}
