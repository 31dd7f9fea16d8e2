// Words of the ambient occlusion: a distance along the view axis (m) in the upper 22 bits, to 3e-5 of it, and ten bits of
// something else. One fetch instead of two, and no halves to widen.

// Occluders to a point at which A is computed, each way.
const int OCCLUSION_SPACING = 2;

/// Distance where nothing is, metres: farther than any radius.
const float NOWHERE = 1e18;

uint distance_pack(float distance) {
    return ((floatBitsToUint(distance) + 0x100u) >> 9) << 10;
}

/// Distance along the view axis, metres.
float packed_distance(uint word) {
    return uintBitsToFloat((word >> 1) & 0x7ffffe00u);
}

/// A surface and the thickness of the body behind it (m), to an eighth.
uint occluder_pack(float distance, float thickness) {
    return distance_pack(distance) | floatBitsToUint(thickness) >> 21;
}

/// Thickness of the body behind the surface, metres.
float occluder_thickness(uint word) {
    // The distance's last bit comes along as the sign.
    return abs(uintBitsToFloat(word << 21));
}

// A is 1 less a multiple of this: single slices go down to 1 - pi/2. No occlusion is a word of 0 at no distance.
const float OCCLUSION_STEP = 1.0 / 640.0;

/// A surface and its ambient occlusion A, 1 - pi/2 .. 1.
uint occlusion_pack(float a, float distance) {
    return distance_pack(distance) | uint(clamp((1.0 - a) / OCCLUSION_STEP + 0.5, 0.0, 1023.0));
}

/// A, with its distance along the view axis (m).
vec2 occlusion_unpack(uint word) {
    return vec2(1.0 - float(int(word & 1023u)) * OCCLUSION_STEP, packed_distance(word));
}
