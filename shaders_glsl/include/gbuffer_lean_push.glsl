layout(push_constant, scalar) uniform Push {
    mat4 clip_from_world;
    vec3 diffuse;  // rho_d
    uint material; // index into the table of materials
} push;
