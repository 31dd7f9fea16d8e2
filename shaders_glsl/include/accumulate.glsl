// Running mean of the frames, in 32-bit floats: m_k = m_(k-1) + (x_k - m_(k-1)) / k.

layout(set = 0, binding = 0) uniform sampler2D frame;
layout(set = 0, binding = 1) uniform sampler2D previous_mean;

layout(push_constant, scalar) uniform Push {
    uint count; // frames including this one
} push;

vec4 mean_at(ivec2 pixel) {
    vec4 x = texelFetch(frame, pixel, 0);
    if (push.count <= 1u) return x;
    vec4 m = texelFetch(previous_mean, pixel, 0);
    return m + (x - m) / float(push.count);
}
