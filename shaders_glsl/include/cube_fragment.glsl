// A texel of a cube that is drawn layer by layer: what `cube_faces.geom` hands to a fragment shader.

layout(location = 0) in vec2 face_st;
layout(location = 1) flat in int face;

/// Direction through the centre of the texel, unit.
vec3 texel_direction() {
    return normalize(cube_direction(face, face_st));
}
