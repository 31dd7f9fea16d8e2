#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "bvh.glsl"

// Traces given rays, for tests against the CPU. An invocation is a ray.

layout(local_size_x = 64) in;

// Occlusion only, instead of the nearest hit.
layout(constant_id = 0) const bool ANY = false;

struct Ray {
    vec3 origin;
    vec3 toward;
};

layout(set = 0, binding = 0, scalar) buffer Rays { Ray rays[]; };
// Nearest hit: distance, or FAR; position of the triangle, barycentrics. ANY: 1 if something is hit.
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2DArray hits;

layout(push_constant, scalar) uniform Push {
    uint count;
} push;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.count) return;
    Ray ray = rays[index];
    vec4 result;
    if (ANY) result = vec4(float(any_hit(ray.origin, ray.toward, FAR)));
    else {
        Hit hit = closest(ray.origin, ray.toward, FAR);
        result = vec4(hit.distance, float(hit.triangle), hit.barycentrics);
    }
    uint columns = uint(imageSize(hits).x);
    imageStore(hits, ivec3(index % columns, index / columns, 0), result);
}
