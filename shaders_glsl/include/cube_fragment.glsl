// Texel addressing for fragment shaders that draw a cube with layered rendering: inputs from `cube_faces.geom`.

layout(location = 0) in vec2 face_st;
layout(location = 1) flat in int face;

/// Unit direction through the texel's centre.
vec3 texel_direction() {
    return normalize(cube_direction(face, face_st));
}
