layout(push_constant, scalar) uniform Push {
    mat4 shadow_from_world;
    float cutoff; // alpha below it is a hole
} push;
