layout(push_constant, scalar) uniform Push {
    mat4 shadow_from_world;
    vec3 internal; // what one passage straight through the glass leaves
    vec3 toward;   // unit, toward the light
} push;
