// The surface that a ray hits.
#include "bvh.glsl"
#include "octahedral.glsl"
#include "facing.glsl"
#include "shared_exponent.glsl"

struct Surface {
    vec3 position;   // world, metres, lifted off the surface
    vec3 normal;     // unit, on the side that was hit: of the face, or of a cut-out, whose leaves have normals of their crown
    vec3 albedo;     // rho_d, mean over the triangle
    vec3 emission;   // radiance L_e, kcd/m^2, mean over the triangle
};

/// Reflectance from 10 + 11 + 11 bits.
vec3 albedo_unpack(uint word) {
    return vec3(word & 0x7ffu, (word >> 11) & 0x7ffu, word >> 22) / vec3(2047.0, 2047.0, 1023.0);
}

/// The normal in the word of a cut-out, unit.
vec3 cut_out_normal(uint word) {
    uvec2 bits = uvec2(word >> OPACITY_BITS, word >> (OPACITY_BITS + NORMAL_BITS)) & ((1u << NORMAL_BITS) - 1u);
    return octahedral_decode(vec2(bits) / float((1u << NORMAL_BITS) - 1u) * 2.0 - 1.0);
}

Surface surface_of(Hit hit, vec3 origin, vec3 toward) {
    uint albedo = triangle_texel(hit.triangle, 0u).w;
    uvec4 second = triangle_texel(hit.triangle, 1u);
    uvec4 third = triangle_texel(hit.triangle, 2u);
    vec3 face = normalize(cross(uintBitsToFloat(second.xyz), uintBitsToFloat(third.xyz)));
    if (dot(face, toward) > 0.0) face = -face;
    vec3 normal = is_cut_out(third.w) ? facing(cut_out_normal(third.w), face, CUT_OUT_SLACK) : face;
    return Surface(lifted(origin + hit.distance * toward, face), normal, albedo_unpack(albedo), shared_exponent_unpack(second.w));
}
