// Karis 2013, "Real Shading in Unreal Engine 4": the sky about a direction r, weighted by the GGX lobe of an eye and a normal in
// that direction. The samples have the density of the distribution of normals; their weight is the cosine.
#include "filtered.glsl"
#include "frame.glsl"

layout(set = 0, binding = 0) uniform samplerCube sky_radiance; // kcd/m^2
layout(set = 0, binding = 1, scalar) readonly buffer Samples {
    vec4 samples[]; // xyz: directions about +z; w: mip level of the lookup
};

layout(push_constant, scalar) uniform Push {
    uint count; // samples
} push;

/// Prefiltered radiance, kcd/m^2; a: 1.
vec4 prefiltered(vec3 r) {
    mat3 frame = frame_from_normal(r);
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < push.count; ++i) {
        vec4 local = samples[i];
        // Filtered importance sampling (Krivanek and Colbert 2008).
        sum += local.z * vec4(filtered(sky_radiance, frame * local.xyz, local.w).rgb, 1.0);
    }
    return vec4(sum.rgb / sum.a, 1.0);
}
