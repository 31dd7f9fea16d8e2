// Dither before rounding to 8 bits, so that smooth dark pictures have no bands. One noise for all channels: grey stays grey.

/// Two numbers in [-0.5, 0.5) from a pixel: PCG2D (Jarzynski & Olano 2020, "Hash Functions for GPU Rendering").
vec2 dither_noise(uvec2 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    v ^= v >> 16u;
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    v ^= v >> 16u;
    return vec2(v >> 8u) / 16777216.0 - 0.5;
}

/// Noise in steps for values `from_end` steps from black or white. The first number alone makes the mean of the rounded values that of the true ones;
/// the second makes their variance the same everywhere, which is left out near the ends: nothing is clamped there, and black stays black.
vec3 dither_steps(vec2 noise, vec3 from_end) {
    return noise.x + noise.y * clamp(2.0 * from_end, 0.0, 1.0);
}

/// Dithers encoded values in 0..1.
vec3 dither_encoded(vec3 c, uvec2 pixel) {
    vec3 from_end = min(c, 1.0 - c) * 255.0;
    return c + dither_steps(dither_noise(pixel), from_end) / 255.0;
}

/// Dithers linear values in 0..1 that the target's sRGB format encodes. The noise is scaled by the slope of the decoding, within 9 %.
vec3 dither_linear(vec3 c, uvec2 pixel) {
    vec3 from_end = min(c * 12.92, (1.0 - c) / 2.275) * 255.0;
    vec3 slope = max(vec3(1.0 / 12.92), 1.47 * sqrt(c) + 0.805 * c);
    return c + dither_steps(dither_noise(pixel), from_end) * slope / 255.0;
}
