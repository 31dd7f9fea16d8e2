layout(push_constant, scalar) uniform Push {
    mat4 shadow_from_world;
    float cutoff; // fragments with alpha below it are discarded
} push;
