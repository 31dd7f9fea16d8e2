// Low-discrepancy points, as in `daylight::sampling` on the CPU. Needs random.glsl.

/// Sobol' 1967, first two dimensions: point `index` as 32-bit fractions.
uvec2 sobol(uint index) {
    uint bits = 0u, direction = 1u << 31;
    for (uint left = index; left != 0u; left >>= 1) {
        if ((left & 1u) != 0u) bits ^= direction;
        direction ^= direction >> 1;
    }
    return uvec2(bitfieldReverse(index), bits);
}

/// Nested uniform scrambling (Laine and Karras 2011), multipliers of Burley 2020.
uint scrambled(uint bits, uint seed) {
    uint v = bitfieldReverse(bits);
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16) | 1u;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return bitfieldReverse(v);
}

/// Point `index` of `sobol`, scrambled by `seed`, in [0, 1)^2.
vec2 scrambled_sobol(uint index, uint seed) {
    uvec2 bits = sobol(index);
    uvec2 v = uvec2(scrambled(bits.x, tea(seed, 0u)), scrambled(bits.y, tea(seed, 1u)));
    return vec2(v >> 8) / 16777216.0;
}

/// Direction about n with density cos / pi, from a point in [0, 1)^2.
vec3 cosine_direction(vec3 n, vec2 xi) {
    float sine = sqrt(xi.x), phi = 2.0 * PI * xi.y;
    return frame_from_normal(n) * vec3(sine * cos(phi), sine * sin(phi), sqrt(1.0 - xi.x));
}
