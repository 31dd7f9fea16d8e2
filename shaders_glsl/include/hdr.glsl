// Signals of HDR screens, as `daylight::hdr` has them.

/// Linear BT.2020 from linear BT.709 (ITU-R BT.2087, not rounded); in columns.
const mat3 BT2020_FROM_BT709 = mat3(
    0.627403895934699, 0.069097289358232, 0.016391438875150,
    0.329283038377884, 0.919540395075458, 0.088013307877226,
    0.043313065687417, 0.011362315566309, 0.895595253247624);

/// The inverse EOTF of SMPTE ST 2084, from luminances in units of 10 000 cd/m^2.
vec3 pq_signal(vec3 luminance) {
    const float m1 = 2610.0 / 16384.0;
    const float m2 = 2523.0 / 4096.0 * 128.0;
    const float c1 = 3424.0 / 4096.0;
    const float c2 = 2413.0 / 4096.0 * 32.0;
    const float c3 = 2392.0 / 4096.0 * 32.0;
    vec3 y = pow(clamp(luminance, 0.0, 1.0), vec3(m1));
    return pow((c1 + c2 * y) / (1.0 + c3 * y), vec3(m2));
}

/// A colour that a screen can show whose highest display value is `peak`: up to it nothing changes; brighter colours are scaled down and turn to white,
/// as beyond the shoulder of Khronos PBR Neutral.
vec3 bounded(vec3 c, float peak) {
    c = min(c, 1e6); // so that infinite ones stay numbers
    float most = max(c.r, max(c.g, c.b));
    float excess = max(most - peak, 0.0);
    float grey = 1.0 - 1.0 / (0.15 * excess + 1.0);
    return mix(c * (peak / max(most, peak)), vec3(peak), grey);
}
