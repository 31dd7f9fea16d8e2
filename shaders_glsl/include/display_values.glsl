// Means of display values, for anti-aliasing.

// The display values are linear, for an HDR screen.
layout(constant_id = 40) const bool LINEAR = false;

/// Frames of alpha 1, and the most that a mean has.
const float FRAMES = 255.0;
const float MOST_FRAMES = 10.0;

/// Linear light of display values, nearly: a square for the sRGB curve. Its root takes them back exactly.
vec3 light_of_display(vec3 c) {
    return LINEAR ? c : c * c;
}

vec3 display_of_light(vec3 c) {
    return LINEAR ? c : sqrt(c);
}

/// A value to be stored in 8 bits, up or down so that the mean over frames and pixels is the value itself: noise of the R2 sequence
/// (Roberts 2018).
vec3 rounded(vec3 c, vec2 pixel, float shift) {
    if (LINEAR) return c;
    float noise = fract(dot(pixel, vec2(0.7548777, 0.5698403)) + shift);
    return c + (noise - 0.5) / 255.0;
}
