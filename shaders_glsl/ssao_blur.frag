#version 460
#extension GL_EXT_scalar_block_layout : require

// Takes out the 4x4 pattern of ssao.frag by a box of its size that does not cross depth edges.

layout(location = 0) out vec2 occlusion; // A, distance along the view axis (m)

layout(set = 0, binding = 0) uniform sampler2D noisy_occlusion;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(noisy_occlusion, 0) - 1;
    vec2 centre = texelFetch(noisy_occlusion, pixel, 0).rg;
    // The slope of a plane seen at a grazing angle is no edge: the tolerance follows the smaller neighbouring step.
    float left = texelFetch(noisy_occlusion, max(pixel - ivec2(1, 0), 0), 0).g;
    float right = texelFetch(noisy_occlusion, min(pixel + ivec2(1, 0), last), 0).g;
    float up = texelFetch(noisy_occlusion, max(pixel - ivec2(0, 1), 0), 0).g;
    float down = texelFetch(noisy_occlusion, min(pixel + ivec2(0, 1), last), 0).g;
    float slope = min(abs(left - centre.g), abs(right - centre.g))
                + min(abs(up - centre.g), abs(down - centre.g));
    float scale = 1.0 / (0.01 * centre.g + 3.0 * slope + 1e-6);
    vec2 sum = vec2(0.0);
    for (int y = -2; y < 2; ++y) {
        for (int x = -2; x < 2; ++x) {
            vec2 tap = texelFetch(noisy_occlusion, clamp(pixel + ivec2(x, y), ivec2(0), last), 0).rg;
            float w = max(1.0 - abs(tap.g - centre.g) * scale, 0.0);
            sum += vec2(tap.r, 1.0) * w;
        }
    }
    // The pixel itself always counts (w = 1), so the sum of weights is at least one.
    occlusion = vec2(clamp(sum.r / sum.g, 0.0, 1.0), centre.g);
}
