// The surface that a ray hits.
#include "bvh.glsl"
#include "shared_exponent.glsl"

struct Surface {
    vec3 position;   // world, metres, lifted off the surface
    vec3 normal;     // of the face, unit, on the side that was hit
    vec3 albedo;     // rho_d, mean over the triangle
    vec3 emission;   // radiance L_e, kcd/m^2, mean over the triangle
};

/// Reflectance from 10 + 11 + 11 bits.
vec3 albedo_unpack(uint word) {
    return vec3(word & 0x7ffu, (word >> 11) & 0x7ffu, word >> 22) / vec3(2047.0, 2047.0, 1023.0);
}

Surface surface_of(Hit hit, vec3 origin, vec3 toward) {
    uint albedo = triangle_texel(hit.triangle, 0u).w;
    uvec4 second = triangle_texel(hit.triangle, 1u);
    vec3 edge2 = uintBitsToFloat(triangle_texel(hit.triangle, 2u).xyz);
    vec3 face = normalize(cross(uintBitsToFloat(second.xyz), edge2));
    if (dot(face, toward) > 0.0) face = -face;
    return Surface(lifted(origin + hit.distance * toward, face), face, albedo_unpack(albedo), shared_exponent_unpack(second.w));
}
