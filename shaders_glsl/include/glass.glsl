// Panes of clear glass, as in daylight::glass: two parallel surfaces, reflections between them without end.

// Index of refraction, set by every pipeline that meets panes.
layout(constant_id = 40) const float GLASS_INDEX = 1.5;

/// What the two polarisations see of one surface, by the cosine outside: their reflectances, and the cosine inside.
vec3 glass_surface(float cosine) {
    float outside = clamp(abs(cosine), 1e-4, 1.0);
    float inside = sqrt(1.0 - (1.0 - outside * outside) / (GLASS_INDEX * GLASS_INDEX));
    float across = (outside - GLASS_INDEX * inside) / (outside + GLASS_INDEX * inside);
    float along = (GLASS_INDEX * outside - inside) / (GLASS_INDEX * outside + inside);
    return vec3(across * across, along * along, inside);
}

/// Transmittance of a pane for light whose direction has this cosine with the normal. `internal`: what one passage straight through
/// the glass leaves.
vec3 pane_transmittance(vec3 internal, vec3 surface) {
    vec3 passage = pow(internal, vec3(1.0 / surface.z));
    vec3 across = passage * ((1.0 - surface.x) * (1.0 - surface.x)) / (1.0 - surface.x * surface.x * passage * passage);
    vec3 along = passage * ((1.0 - surface.y) * (1.0 - surface.y)) / (1.0 - surface.y * surface.y * passage * passage);
    return 0.5 * (across + along);
}

/// Reflectance of the pane.
vec3 pane_reflectance(vec3 internal, vec3 surface) {
    vec3 passage = pow(internal, vec3(1.0 / surface.z));
    vec3 back = passage * passage;
    vec3 across = surface.x * (1.0 + back * ((1.0 - surface.x) * (1.0 - surface.x)) / (1.0 - surface.x * surface.x * back));
    vec3 along = surface.y * (1.0 + back * ((1.0 - surface.y) * (1.0 - surface.y)) / (1.0 - surface.y * surface.y * back));
    return 0.5 * (across + along);
}
