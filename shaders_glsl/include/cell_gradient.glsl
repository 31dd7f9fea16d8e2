// How the irradiance of a cell depends on the normal: to first order, by its rotational gradient (Ward & Heckbert 1992, "Irradiance
// Gradients"). The gradient of light from one direction is its irradiance times the tangent of the angle to the normal, along the surface.

// Least cosine between normal and light in the estimate of the gradient, which bounds its noise.
const float LEAST_COSINE = 0.3;
// Paths with which half of a gradient counts.
const float FEW_PATHS = 64.0;
// Largest component of a gradient relative to its irradiance.
const float STEEPEST = 4.0;

/// The gradient of an irradiance from a direction.
vec3 gradient_of(float irradiance, vec3 toward, vec3 n) {
    float cosine = dot(toward, n);
    return irradiance / max(cosine, LEAST_COSINE) * (toward - cosine * n);
}

/// A gradient relative to its irradiance, in 11 + 11 + 10 bits. That of few paths is mostly noise.
uint gradient_pack(vec3 gradient, float irradiance, float samples) {
    vec3 relative = irradiance > 0.0 ? gradient / irradiance * (samples / (samples + FEW_PATHS)) : vec3(0.0);
    uvec3 bits = uvec3(clamp(0.5 * relative / STEEPEST + 0.5, 0.0, 1.0) * vec3(2046.0, 2046.0, 1022.0) + 0.5);
    return bits.x | bits.y << 11 | bits.z << 22;
}

/// Factor on the irradiance of a cell for a surface of this normal, bounded.
float toward_normal(uint word, vec3 n) {
    vec3 unit = vec3(word & 0x7ffu, (word >> 11) & 0x7ffu, word >> 22) / vec3(2046.0, 2046.0, 1022.0);
    return clamp(1.0 + STEEPEST * dot(2.0 * unit - 1.0, n), 0.25, 2.0);
}
