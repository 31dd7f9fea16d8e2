// The face under a pixel, for shadow maps that are compared in its plane. Reversed depth d is linear over the picture, so two
// slopes are all there is to know of a triangle's plane, and its own are exact where differences to neighbours are not: on what
// is a few pixels wide.

// Whether the G-buffer keeps them.
layout(constant_id = 8) const bool FACES = false;

/// Relative change of depth from pixel to pixel, as two halves.
uint face_slopes() {
    // A triangle seen from its edge has slopes that a half cannot hold; of those a pixel wide, 100 is a great lot.
    return FACES ? packHalf2x16(clamp(vec2(dFdx(gl_FragCoord.z), dFdy(gl_FragCoord.z)) / gl_FragCoord.z, -100.0, 100.0) * 256.0) : 0u;
}

