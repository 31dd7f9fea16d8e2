// The directions of a frame: members of a uniform block, tiles of one image of maps.
#define DOME_BLOCK \
    mat4 clip_from_world[16]; \
    mat4 planes[16];  /* its inverse transpose */ \
    vec4 window[16];  /* first texel of the map and its edges */ \
    vec4 toward[16];  /* unit, toward the light; a: bias of depth */ \
    vec4 light[16];   /* share of the irradiance at normal incidence, klx; a: 1 of the sky, 0 of the ground */
