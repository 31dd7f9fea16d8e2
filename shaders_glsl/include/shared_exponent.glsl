#ifndef SHARED_EXPONENT_GLSL
#define SHARED_EXPONENT_GLSL
// Colours in 32 bits: three mantissas of 9 bits with one exponent (as VK_FORMAT_E5B9G9R9_UFLOAT_PACK32). The largest value is 65 408.

uint shared_exponent_pack(vec3 rgb) {
    vec3 c = clamp(rgb, 0.0, 65408.0);
    float most = max(c.r, max(c.g, c.b));
    // Exponent of the power of two above the largest component.
    int e = max(int(floatBitsToUint(most) >> 23) - 126, -15);
    // Rounding may carry it over to the next.
    if (most * exp2(float(9 - e)) + 0.5 >= 512.0) ++e;
    uvec3 m = uvec3(c * exp2(float(9 - e)) + 0.5);
    return m.r | m.g << 9 | m.b << 18 | uint(e + 15) << 27;
}

vec3 shared_exponent_unpack(uint word) {
    // 2^(exponent - 15 - 9), made from its bits.
    float scale = uintBitsToFloat(((word >> 27) + 103u) << 23);
    return vec3(word & 0x1ffu, (word >> 9) & 0x1ffu, (word >> 18) & 0x1ffu) * scale;
}

// Irradiances, klx, up to 4 088: 1e-6 klx of a night keep eight bits.
const float IRRADIANCE_STEPS = 16.0;

uint irradiance_pack(vec3 klx) {
    return shared_exponent_pack(klx * IRRADIANCE_STEPS);
}

vec3 irradiance_unpack(uint word) {
    return shared_exponent_unpack(word) / IRRADIANCE_STEPS;
}
#endif
