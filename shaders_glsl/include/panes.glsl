// Panes of glass before the picture: transmittance, and what they mirror, see light::panes.

// Whether the scene has panes, set by every pipeline that shows radiance; otherwise any images are bound.
layout(constant_id = 41) const bool PANES = false;

layout(set = 0, binding = 26) uniform sampler2D panes_transmittance;
layout(set = 0, binding = 27) uniform sampler2D panes_mirrored; // kcd/m^2

/// What the panes let through of the light of a pixel.
vec3 through_panes(ivec2 pixel) {
    return PANES ? texelFetch(panes_transmittance, pixel, 0).rgb : vec3(1.0);
}

/// What the panes mirror at a pixel, kcd/m^2.
vec3 mirrored_by_panes(ivec2 pixel) {
    return PANES ? texelFetch(panes_mirrored, pixel, 0).rgb : vec3(0.0);
}
