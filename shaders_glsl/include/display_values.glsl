// Means of display values, for anti-aliasing.

// The display values are linear, for an HDR screen.
layout(constant_id = 40) const bool LINEAR = false;

/// Linear light of display values, nearly: a square for the sRGB curve. Its root takes them back exactly.
vec3 light_of_display(vec3 c) {
    return LINEAR ? c : c * c;
}

vec3 display_of_light(vec3 c) {
    return LINEAR ? c : sqrt(c);
}

/// A value to be stored in 8 bits, up or down so that the mean over many frames and pixels is the value itself (noise of Jimenez 2014).
vec3 rounded(vec3 c, vec2 pixel, float shift) {
    if (LINEAR) return c;
    float noise = fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715))) + shift);
    return c + (noise - 0.5) / 255.0;
}
