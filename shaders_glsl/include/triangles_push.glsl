layout(push_constant, scalar) uniform Push {
    mat4 clip_from_world;
    uint first; // number of the first triangle of the draw, in the index buffer
} push;
