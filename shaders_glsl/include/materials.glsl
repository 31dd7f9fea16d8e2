// The table of materials: an image with a nearest sampler. Three texel rows hold as many materials as there are columns.
#include "texel.glsl"

// Columns of the table, set by every pipeline that reads it.
layout(constant_id = 30) const uint MATERIAL_COLUMNS = 1u;

/// Packs a surface's material number and the upper half of the bits of its body's thickness (metres).
uint material_word(uint number, float thickness) {
    return number | (floatBitsToUint(thickness) & 0xffff0000u);
}

/// Unpacks the thickness of the body behind the surface, metres.
float material_thickness(uint word) {
    return uintBitsToFloat(word & 0xffff0000u);
}

/// One of the three table rows of a word's material.
vec4 material_row(sampler2D materials, uint word, uint row) {
    uint number = word & 0xffffu;
    return texel_at(materials, vec2(number % MATERIAL_COLUMNS, 3u * (number / MATERIAL_COLUMNS) + row));
}

/// The second row; rgb: rho_s; a: shininess p.
vec4 material_specular(sampler2D materials, uint word) {
    return material_row(materials, word, 1u);
}

/// L_e, kcd/m^2, without its map.
vec3 material_emission(sampler2D materials, uint word) {
    return material_row(materials, word, 2u).rgb;
}

/// rgb: rho_d of a pixel; a: factor on rho_s. From an image, or from the material if the scene has no maps.
vec4 pixel_albedo(bool from_image, sampler2D albedo, sampler2D materials, uint word, vec2 uv) {
    if (from_image) return textureLod(albedo, uv, 0.0);
    return vec4(material_row(materials, word, 0u).rgb, 1.0);
}
