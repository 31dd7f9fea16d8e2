// The table of materials: an image of rows of so many columns, two rows to each 1024 materials.
const int MATERIAL_COLUMNS = 1024;

/// The word of a surface: the number of its material, and the upper half of the bits of how thick its body is (metres).
uint material_word(uint number, float thickness) {
    return number | (floatBitsToUint(thickness) & 0xffff0000u);
}

/// How thick the body is behind the surface of a word, metres.
float material_thickness(uint word) {
    return uintBitsToFloat(word & 0xffff0000u);
}

/// Where the first of the two rows has the material of a word of the G-buffer: rgb: rho_d.
ivec2 material_diffuse(uint word) {
    int number = int(word & 0xffffu);
    return ivec2(number % MATERIAL_COLUMNS, 2 * (number / MATERIAL_COLUMNS));
}

/// rho_d of a pixel, and a factor on rho_s: from an image, or of the material where the scene has no maps.
vec4 pixel_albedo(bool from_image, sampler2D albedo, sampler2D materials, uint word, ivec2 pixel) {
    if (from_image) return texelFetch(albedo, pixel, 0);
    return vec4(texelFetch(materials, material_diffuse(word), 0).rgb, 1.0);
}

/// The second: rgb: rho_s; a: shininess p.
ivec2 material_specular(uint word) {
    return material_diffuse(word) + ivec2(0, 1);
}
