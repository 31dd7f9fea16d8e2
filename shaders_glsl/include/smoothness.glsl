// The word of the G-buffer with the number of the material: in the upper 8 bits 1 minus the factor of a map on the roughness, in steps of
// 1/255. Without a map it is the number alone.

const uint MATERIAL_BITS = 24u;

uint smoothness_pack(float factor) {
    return uint(255.5 - 255.0 * clamp(factor, 0.0, 1.0)) << MATERIAL_BITS;
}

/// Factor on the roughness of the material.
float roughness_factor(uint word) {
    return 1.0 - float(word >> MATERIAL_BITS) / 255.0;
}

/// Number of the material.
uint material_of(uint word) {
    return word & ((1u << MATERIAL_BITS) - 1u);
}
