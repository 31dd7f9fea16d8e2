// The face under a fragment, from derivatives.
#include "face.glsl"
#include "facing.glsl"

/// The shading normal on the viewer's side, not normalized. Winding and stored normals of real models disagree too often to
/// trust either, so the true face, from derivatives, decides the side. Surfaces are two-sided.
/// `slack`: see `facing`.
vec3 facing_normal(vec3 shading_normal, vec3 from_eye, float slack) {
    vec3 face = cross(dFdx(from_eye), dFdy(from_eye));
    face *= dot(face, from_eye) > 0.0 ? -1.0 : 1.0;
    return facing(shading_normal, face, slack);
}

/// Relative change of depth from pixel to pixel, as two halves.
uint face_slopes() {
    vec2 slopes = vec2(dFdx(gl_FragCoord.z), dFdy(gl_FragCoord.z)) / gl_FragCoord.z;
    return slopes_pack(slopes);
}
