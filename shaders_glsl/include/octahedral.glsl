#ifndef OCTAHEDRAL_GLSL
#define OCTAHEDRAL_GLSL
// Octahedral encoding (Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors").

vec2 sign_not_zero(vec2 v) {
    return vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0);
}

/// Unit vector to [-1,1]^2.
vec2 octahedral_encode(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    return n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * sign_not_zero(p);
}

/// Encodes a direction of any length for the G-buffer: 16 bits per component, precise to 0.003 degrees.
uint normal_pack(vec3 n) {
    return packSnorm2x16(octahedral_encode(n));
}

/// [-1,1]^2 to a unit vector.
vec3 octahedral_decode(vec2 p) {
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * sign_not_zero(n.xy);
    return normalize(n);
}

/// Decodes a G-buffer word to a unit vector.
vec3 normal_unpack(uint word) {
    return octahedral_decode(unpackSnorm2x16(word));
}
#endif
