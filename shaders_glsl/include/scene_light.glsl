// The light of a moment and the grid of cells, as the passes of the bounces see them.
#include "colour.glsl"
#include "constants.glsl"
#include "frame.glsl"
#include "octahedral.glsl"
#include "random.glsl"
#include "sobol.glsl"

layout(set = 0, binding = 22, scalar) uniform Scene {
    vec3 eye;              // world, metres: cells are larger far from it
    float cell;            // edge of the smallest cells, metres
    float near;            // distance within which cells have this edge, metres
    vec3 sun_direction;    // unit, toward the sun
    vec3 sun_illuminance;  // at normal incidence, klx
    float sun_tan_radius;  // tangent of the angular radius of the disc
    uint seed;             // of the random numbers
    uint frame;            // number of this update: a new one, new random numbers
} scene;
