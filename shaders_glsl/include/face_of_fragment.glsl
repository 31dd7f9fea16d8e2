// The face under a fragment, from derivatives.
#include "face.glsl"

/// The shading normal on the viewer's side, not normalized. Winding and stored normals of real models disagree too often to
/// trust either, so the true face, from derivatives, decides the side. Surfaces are two-sided.
/// `slack` (0..1): a normal is flipped only if its cosine with the face normal is less than -slack.
vec3 facing_normal(vec3 shading_normal, vec3 from_eye, float slack) {
    vec3 face = cross(dFdx(from_eye), dFdy(from_eye));
    face *= dot(face, from_eye) > 0.0 ? -1.0 : 1.0;
    float limit = slack > 0.0 ? -slack * length(face) * length(shading_normal) : 0.0;
    return dot(shading_normal, face) < limit ? -shading_normal : shading_normal;
}

/// Relative change of depth from pixel to pixel, as two halves.
uint face_slopes() {
    vec2 slopes = vec2(dFdx(gl_FragCoord.z), dFdy(gl_FragCoord.z)) / gl_FragCoord.z;
    return packHalf2x16(clamp(slopes, -MAX_SLOPE, MAX_SLOPE) * SLOPE_SCALE);
}
