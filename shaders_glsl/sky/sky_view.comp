#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// The whole view of an observer under one sun, as daylight::atmosphere::sky_view on the CPU.
#include "atmosphere.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2, rgba32f) uniform writeonly image2DArray sky_view; // kcd/m^2, not clipped

layout(push_constant, scalar) uniform Push {
    float sun_sine; // of the sun's true elevation
    float altitude; // of the observer, km
    float horizon;  // elevation of the horizon of the ground, radians
} push;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(sky_view).xy;
    if (any(greaterThanEqual(at, size))) return;
    int half_height = size.y / 2;
    bool below = at.y >= half_height;
    float x = float(at.x) / float(size.x - 1);
    float y = float(at.y % half_height) / float(half_height - 1);
    float elevation = push.horizon + ((below ? -0.5 : 0.5) * PI - push.horizon) * y * y;
    float mu = sin(elevation);
    float across = cos(elevation) * sqrt(max(1.0 - push.sun_sine * push.sun_sine, 0.0));
    float cos_gamma = clamp(mu * push.sun_sine + across * cos(PI * x * x), -1.0, 1.0);
    imageStore(sky_view, ivec3(at, 0), vec4(rgb_of(transfer(push.altitude, mu, push.sun_sine, cos_gamma, below)), 1.0));
}
