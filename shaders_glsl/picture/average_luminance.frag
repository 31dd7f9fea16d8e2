#version 460

// The mean over the tiles of log_luminance.frag, in cd/m^2 again: one texel.

layout(location = 0) out float average_luminance; // kcd/m^2

layout(set = 0, binding = 0) uniform sampler2D log_luminance;

void main() {
    ivec2 size = textureSize(log_luminance, 0);
    float sum = 0.0;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            sum += texelFetch(log_luminance, ivec2(x, y), 0).r;
        }
    }
    average_luminance = exp2(sum / float(size.x * size.y));
}
