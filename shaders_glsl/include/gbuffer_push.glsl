layout(push_constant, scalar) uniform Push {
    mat4 clip_from_world;
    vec3 eye;
    vec3 diffuse;       // rho_d, multiplies the diffuse map
    uint material;      // index into the table of materials
    float cutoff;       // of a cut-out: alpha below it is a hole
    float normal_scale; // factor on the slopes of the normal map
    uint mirrors;       // whether it has a rho_s
    float sharpen;      // mip levels by which maps are sharper than a single sample wants
} push;
