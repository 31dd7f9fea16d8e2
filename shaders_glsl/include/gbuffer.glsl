// Uniforms and push constants of the G-buffer pass.

layout(set = 0, binding = 0, scalar) uniform Camera {
    mat4 clip_from_world;
    vec3 eye;      // world, metres
    float sharpen; // mip bias toward finer levels, relative to one sample per pixel
} camera;

layout(push_constant, scalar) uniform Push {
    vec3 diffuse;       // rho_d or base colour, multiplies the diffuse map
    uint material;      // index into the table of materials
    float cutoff;       // of an alpha-tested surface: fragments with alpha below it are discarded
    float normal_scale; // factor on the slopes of the normal map
    uint is_specular;   // whether it has a rho_s
    float metallic;     // metalness of a surface that reflects by GGX; otherwise negative
} push;
