#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// The air before an eye under one sun, as daylight::atmosphere::aerial on the CPU. Each invocation goes along one ray.
#include "atmosphere.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// Size of the table; of the rows half.
layout(constant_id = 0) const int AZIMUTHS = 32;
layout(constant_id = 1) const int SOURCE_ROWS = 24;
layout(constant_id = 2) const int DENSITY_ROWS = 96;
layout(constant_id = 3) const int STEPS = 24;

layout(set = 0, binding = 2, rgba32f) uniform writeonly image2DArray air_table; // see air.glsl

layout(push_constant, scalar) uniform Push {
    float sun_sine; // of the sun's true elevation
    float altitude; // of the eye, km; and the other parts of Rays
    float ceiling;
    float horizon;
} push;

/// Sine of the elevation of a row of twice `rows`, and whether its ray meets the ground.
float sine_of_row(int row, int rows, out bool meets_ground) {
    meets_ground = row >= rows;
    float side = meets_ground ? -1.0 : 1.0;
    float y = float(row % rows) / float(rows - 1);
    float horizon = push.horizon * side;
    return (horizon + (1.0 - horizon) * y * y * (2.0 - y * y)) * side;
}

Path path_of_row(int row, int rows, out bool meets_ground) {
    float sine = sine_of_row(row, rows, meets_ground);
    Rays rays = Rays(push.altitude, push.ceiling, push.horizon, model.ground_radius);
    return path_of(push.altitude, sine, ray_length(rays, sine, meets_ground));
}

/// Distance of half a step.
float distance_at(float extent, int half_steps, bool meets_ground) {
    float x = 0.5 * float(half_steps) / float(STEPS - 1);
    return extent * (meets_ground ? x * (2.0 - x) : x * x);
}

void mean_densities(int row) {
    bool meets_ground;
    Path path = path_of_row(row, DENSITY_ROWS, meets_ground);
    vec3 column = vec3(0.0);
    vec3 mean = densities(push.altitude);
    int first = 4 * SOURCE_ROWS;
    imageStore(air_table, ivec3(row, first, 0), vec4(mean, 1.0));
    float from = 0.0;
    for (int half_step = 1; half_step < 2 * STEPS - 1; half_step++) {
        float to = distance_at(path.extent, half_step, meets_ground);
        column += densities(point_along(path, 0.5 * (from + to)).altitude) * (to - from);
        from = to;
        if (to > 0.0) mean = column / to;
        if (half_step % 2 == 0) imageStore(air_table, ivec3(row, first + half_step / 2, 0), vec4(mean, 1.0));
    }
}

Source source_along(Path path, float t, float cos_gamma, out vec4 extinction) {
    Point point = point_along(path, t);
    vec3 density = densities(point.altitude);
    extinction = optical_depth(density);
    return source_at(point, density, sun_sine_along(path, t, point, push.sun_sine, cos_gamma), cos_gamma);
}

void store(int row, int entry, int step, vec4 rest, vec4 aerosol) {
    ivec2 at = ivec2(step * AZIMUTHS + entry, row);
    imageStore(air_table, ivec3(at, 0), rest);
    imageStore(air_table, ivec3(at + ivec2(0, 2 * SOURCE_ROWS), 0), aerosol);
}

void mean_sources(int row, int entry) {
    bool meets_ground;
    Path path = path_of_row(row, SOURCE_ROWS, meets_ground);
    float from_middle = 2.0 * float(entry) / float(AZIMUTHS - 1) - 1.0;
    float away = 1.0 - abs(from_middle);
    float azimuth = (1.0 - away * away) * sign(from_middle);
    float across = sqrt(max((1.0 - path.mu * path.mu) * (1.0 - push.sun_sine * push.sun_sine), 0.0));
    float cos_gamma = clamp(path.mu * push.sun_sine + across * azimuth, -1.0, 1.0);

    vec4 extinction;
    Source here = source_along(path, 0.0, cos_gamma, extinction);
    Source mean = Source(here.rest / extinction, here.aerosol / extinction);
    store(row, entry, 0, mean.rest, mean.aerosol);
    vec4 depth = vec4(0.0);
    Source sum = Source(vec4(0.0), vec4(0.0));
    float from = 0.0;
    for (int half_step = 1; half_step < 2 * STEPS - 1; half_step++) {
        float to = distance_at(path.extent, half_step, meets_ground);
        here = source_along(path, 0.5 * (from + to), cos_gamma, extinction);
        vec4 own = extinction * (to - from);
        vec4 weight = exp(-depth) * mean_transmittance(own) * (to - from);
        sum.rest += weight * here.rest;
        sum.aerosol += weight * here.aerosol;
        depth += own;
        from = to;
        vec4 lost = depth * mean_transmittance(depth);
        if (all(greaterThan(lost, vec4(0.0)))) mean = Source(sum.rest / lost, sum.aerosol / lost);
        if (half_step % 2 == 0) store(row, entry, half_step / 2, mean.rest, mean.aerosol);
    }
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= AZIMUTHS) return;
    int sources = 2 * SOURCE_ROWS;
    if (at.y < sources) {
        mean_sources(at.y, at.x);
        return;
    }
    int row = (at.y - sources) * AZIMUTHS + at.x;
    if (row < 2 * DENSITY_ROWS) mean_densities(row);
}
