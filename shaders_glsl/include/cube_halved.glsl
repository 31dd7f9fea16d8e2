// The next mip level of a cube: each texel is the mean of four.
#include "cube.glsl"

layout(set = 0, binding = 0) uniform samplerCube finer; // its first level counts, by a nearest sampler

vec4 halved(int face, ivec2 texel) {
    float edge = float(textureSize(finer, 0).x);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        vec2 from = vec2(2 * texel + ivec2(i & 1, i >> 1)) + 0.5;
        sum += textureLod(finer, cube_direction(face, from / edge), 0.0);
    }
    return 0.25 * sum;
}
