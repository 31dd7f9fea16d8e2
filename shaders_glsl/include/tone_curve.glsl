#include "colour.glsl"

// Tone curves for exposed linear BT.709 (1 is the display's white before the curve); results are linear.

/// Ferschin's exponential mapping (the lecture's slide "Tone mapping"), per channel.
vec3 tone_exponential(vec3 c) {
    return 1.0 - exp(-c);
}

/// The same on luminance, preserving chromaticity: channels may exceed 1.
vec3 tone_exponential_luminance(vec3 c) {
    float l = luminance(c);
    return l > 0.0 ? c * ((1.0 - exp(-l)) / l) : vec3(0.0);
}

/// Reinhard et al. 2002, eq. 4, on luminance: white is the luminance that maps to 1.
vec3 tone_reinhard(vec3 c, float white) {
    float l = luminance(c);
    return c * ((1.0 + l / (white * white)) / (1.0 + l));
}

/// Khronos PBR Neutral tone mapper.
vec3 tone_neutral(vec3 c) {
    const float start = 0.8 - 0.04;
    const float desaturation = 0.15;
    float x = min(c.r, min(c.g, c.b));
    float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
    c -= offset;
    float peak = max(c.r, max(c.g, c.b));
    if (peak < start) return c;
    const float d = 1.0 - start;
    float new_peak = 1.0 - d * d / (peak + d - start);
    c *= new_peak / peak;
    float g = 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0);
    return mix(c, vec3(new_peak), g);
}

/// AgX (Sobotka), base look, 6th-order polynomial fit of its sigmoid (Wrensch's minimal version); linear out.
vec3 tone_agx(vec3 c) {
    const mat3 inset = mat3(
        0.842479062253094, 0.0423282422610123, 0.0423756549057051,
        0.0784335999999992, 0.878468636469772, 0.0784336,
        0.0792237451477643, 0.0791661274605434, 0.879142973793104);
    const mat3 outset = mat3(
        1.19687900512017, -0.0528968517574562, -0.0529716355144438,
        -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
        -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
    const float min_ev = -12.47393;
    const float max_ev = 4.026069;
    vec3 x = clamp(log2(max(inset * c, 1e-10)), min_ev, max_ev);
    x = (x - min_ev) / (max_ev - min_ev);
    vec3 x2 = x * x;
    vec3 x4 = x2 * x2;
    x = 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
    return pow(max(outset * x, 0.0), vec3(2.2));
}

/// ACES, Hill's fit of RRT and ODT, without the exposure factor that some engines add.
vec3 tone_aces(vec3 c) {
    const mat3 in_matrix = mat3(
        0.59719, 0.07600, 0.02840,
        0.35458, 0.90834, 0.13383,
        0.04823, 0.01566, 0.83777);
    const mat3 out_matrix = mat3(
        1.60475, -0.10208, -0.00327,
        -0.53108, 1.10813, -0.07276,
        -0.07367, -0.00605, 1.07602);
    vec3 v = in_matrix * c;
    v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return clamp(out_matrix * v, 0.0, 1.0);
}
