// What a draw of the G-buffer reads.

layout(set = 0, binding = 0, scalar) uniform Camera {
    mat4 clip_from_world;
    vec3 eye;      // world, metres
    float sharpen; // mip levels by which maps are sharper than a single sample wants
} camera;

layout(push_constant, scalar) uniform Push {
    vec3 diffuse;       // rho_d, multiplies the diffuse map
    uint material;      // index into the table of materials
    float cutoff;       // of a cut-out: alpha below it is a hole
    float normal_scale; // factor on the slopes of the normal map
    uint is_specular;   // whether it has a rho_s
} push;
