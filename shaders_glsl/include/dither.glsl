// Dither before rounding to 8 or 10 bits, so that smooth dark pictures have no bands. One noise for all channels: grey stays grey.

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

/// Encoded values in 0..1, with noise in steps: `steps` is 255 for 8 bits. Its first part alone makes the mean of the rounded values that of the true ones; the second
/// makes their variance the same everywhere. Near black and white it is left out: nothing is clamped there, and black stays black. The values are rounded
/// here: a device may round to 8 bits with an error of 0.6 steps.
vec3 dithered(vec3 c, uvec2 pixel, float steps) {
    vec2 noise = dither_noise(pixel);
    vec3 from_end = min(c, 1.0 - c) * steps;
    return floor(c * steps + noise.x + noise.y * clamp(2.0 * from_end, 0.0, 1.0) + 0.5) / steps;
}
