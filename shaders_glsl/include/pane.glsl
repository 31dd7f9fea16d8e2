// The camera of the passes that draw panes of glass, and the glass of a draw.

layout(set = 0, binding = 0, scalar) uniform Camera {
    mat4 clip_from_world;
    vec3 eye;             // world, metres
} camera;

layout(push_constant, scalar) uniform Push {
    vec3 internal; // what one passage straight through the glass leaves
    float scale;   // of what is mirrored
} push;
