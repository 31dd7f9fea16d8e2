// The side of a surface's normal.
#ifndef FACING_GLSL
#define FACING_GLSL

// Foliage cards have normals tilted out of the crown or upward: a normal roughly perpendicular to the face's is not flipped.
const float CUT_OUT_SLACK = 0.5;

/// A normal on the side of a face. Neither need be of unit length. `slack` (0..1): it is flipped only if its cosine with that of the face is less
/// than -slack.
vec3 facing(vec3 normal, vec3 face, float slack) {
    float limit = slack > 0.0 ? -slack * length(face) * length(normal) : 0.0;
    return dot(normal, face) < limit ? -normal : normal;
}
#endif
