// The table of materials: an image of rows of so many columns, two rows to each 1024 materials.
const uint MATERIAL_COLUMNS = 1024u;

/// The word of a surface: the number of its material, and the upper half of the bits of how thick its body is (metres).
uint material_word(uint number, float thickness) {
    return number | (floatBitsToUint(thickness) & 0xffff0000u);
}

/// How thick the body is behind the surface of a word, metres.
float material_thickness(uint word) {
    return uintBitsToFloat(word & 0xffff0000u);
}

/// One of the two rows of the material of a word of the G-buffer; the table's sampler is nearest: a software device checks
/// fetches against the edges, and lookups cost it less.
vec4 material_row(sampler2D materials, uint word, uint row) {
    uint number = word & 0xffffu;
    uvec2 texel = uvec2(number % MATERIAL_COLUMNS, 2u * (number / MATERIAL_COLUMNS) + row);
    return textureLod(materials, (vec2(texel) + 0.5) / vec2(textureSize(materials, 0)), 0.0);
}

/// The second: rgb: rho_s; a: shininess p.
vec4 material_specular(sampler2D materials, uint word) {
    return material_row(materials, word, 1u);
}

/// rho_d of a pixel, and a factor on rho_s: from an image, or of the material where the scene has no maps.
vec4 pixel_albedo(bool from_image, sampler2D albedo, sampler2D materials, uint word, vec2 uv) {
    if (from_image) return textureLod(albedo, uv, 0.0);
    return vec4(material_row(materials, word, 0u).rgb, 1.0);
}
