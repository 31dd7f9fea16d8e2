#version 460
#extension GL_EXT_scalar_block_layout : require

// Running mean of the frames, in 32-bit floats: m_k = m_(k-1) + (x_k - m_(k-1)) / k.

layout(location = 0) out vec4 mean;

layout(set = 0, binding = 0) uniform sampler2D frame;
layout(set = 0, binding = 1) uniform sampler2D previous_mean;

layout(push_constant, scalar) uniform Push {
    uint count; // frames including this one
} push;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 x = texelFetch(frame, pixel, 0);
    if (push.count <= 1u) {
        mean = x;
        return;
    }
    vec4 m = texelFetch(previous_mean, pixel, 0);
    mean = m + (x - m) / float(push.count);
}
