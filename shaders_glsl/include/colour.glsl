#ifndef COLOUR_GLSL
#define COLOUR_GLSL
// XYZ to linear BT.709 (D65), derived exactly (IEC 61966-2-1's rounded matrix differs by up to 4e-4); in columns.
const mat3 RGB_FROM_XYZ = mat3(
    3.2409699419045213, -0.9692436362808796, 0.0556300796969936,
    -1.5373831775700935, 1.8759675015077206, -0.2039769588889765,
    -0.4986107602930033, 0.0415550574071756, 1.0569715142428786);

/// Luminance of a linear BT.709 colour, in the colour's unit.
float luminance(vec3 rgb) {
    return dot(rgb, vec3(0.2126, 0.7152, 0.0722));
}

/// Clips negative components, which saturated sky colours outside of BT.709 have, preserving luminance.
vec3 clip_negative(vec3 rgb) {
    // Without a branch: an early return here crashed a software driver (Mesa 22.3) in the lighting.
    vec3 clamped = max(rgb, 0.0);
    float l = luminance(clamped);
    return clamped * (l > 0.0 ? max(luminance(rgb), 0.0) / l : 0.0);
}

/// sRGB values to linear ones (IEC 61966-2-1).
vec3 linear_from_srgb(vec3 c) {
    return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045)));
}

/// Linear values to sRGB ones, the inverse.
vec3 srgb_from_linear(vec3 c) {
    return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, c * 12.92, lessThanEqual(c, vec3(0.0031308)));
}
#endif
