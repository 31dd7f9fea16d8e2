const float PI = 3.14159265358979;

/// Luminance of linear BT.709, same unit as the colour.
float luminance(vec3 rgb) {
    return dot(rgb, vec3(0.2126, 0.7152, 0.0722));
}
