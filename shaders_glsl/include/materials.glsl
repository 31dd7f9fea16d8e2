// The table of materials: an image with a nearest sampler. Three texel rows hold as many materials as there are columns.
// A material is Phong's or, marked by a shininess below 0, GGX's (see microfacet.glsl):
//   rgb: rho_d, a: 0            rgb: base colour, a: F90 of the dielectric
//   rgb: rho_s, a: p            rgb: F0 of the dielectric, a: -1 - roughness
//   rgb: L_e, a: 0              rgb: L_e, a: metalness
// `word` of the functions is that of the G-buffer.
#include "smoothness.glsl"
#include "texel.glsl"

// Columns of the table, set by every pipeline that reads it.
layout(constant_id = 30) const uint MATERIAL_COLUMNS = 1u;

/// One of the three table rows of a material.
vec4 material_row(sampler2D materials, uint word, uint row) {
    uint number = material_of(word);
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

/// rgb: rho_d of a pixel, or base colour; a: factor on rho_s, or metalness. From an image, or from the material if the scene has no
/// maps: then a is 1.
vec4 pixel_albedo(bool from_image, sampler2D albedo, sampler2D materials, uint word, vec2 uv) {
    if (from_image) return textureLod(albedo, uv, 0.0);
    return vec4(material_row(materials, word, 0u).rgb, 1.0);
}
