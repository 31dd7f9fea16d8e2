// Light along a path through the air, as daylight::atmosphere computes it on the CPU; functions have the names they have there. Lengths in km.
#include "air_rays.glsl"

const int COEFFICIENTS = 10;

layout(set = 0, binding = 0, scalar) uniform Model {
    vec4 rayleigh;           // scattering by molecules at sea level, 1/km, at the four wavelengths
    vec4 aerosol_scattering; // scattering by the aerosol at sea level, 1/km
    vec4 aerosol;            // its extinction
    vec4 ozone;              // absorption by ozone at its peak
    vec3 rgb[4];             // radiance, kcd/m^2, of a transfer of 1 at each wavelength
    float ln_density[64];    // of the air, each density_step
    float density_step;
    vec2 ozone_tent;         // altitude of the peak, half width
    float scale_height;      // of the aerosol
    float asymmetry;         // of the aerosol
    vec3 rayleigh_phase;     // a, b of a + b cos^2, and the moment of degree 2
    float ground_albedo;
    float ground_radius;
    float thickness;         // of the air
    float sun_radius;        // of the disc, radians
    ivec2 depth_size;        // entries and rows of the optical depths
    ivec2 field_size;        // altitudes and suns of the field
    int low_steps;           // of the sun's grid
    vec3 sun_grid;           // its least and high sine, slope at the high one
    int cells;               // of a path to the top of the air
    int ground_cells;        // of a path to the ground
} model;

/// Optical depths to the top of the air, then the field, then the irradiance of the ground.
layout(set = 0, binding = 1, scalar) readonly buffer Air {
    vec4 tables[];
} air;

struct Point {
    float altitude;
    float radius;
    float mu;
};

struct Path {
    float altitude; // of the start
    float mu;       // cosine with the vertical there
    float extent;
    float lowest;   // distance of the lowest point
    float from;     // signed roots of the distances of the ends from it
    float to;
};

float horizon_distance(float altitude) {
    return sqrt(altitude * (2.0 * model.ground_radius + altitude));
}

float distance_to_top(float altitude, float mu) {
    float height = (model.thickness - altitude) * (2.0 * model.ground_radius + model.thickness + altitude);
    float along = (model.ground_radius + altitude) * mu;
    float root = sqrt(max(height + along * along, 0.0));
    return along > 0.0 ? height / (root + along) : root - along;
}

float distance_to_ground(float altitude, float mu) {
    float height = altitude * (2.0 * model.ground_radius + altitude);
    float along = (model.ground_radius + altitude) * mu;
    float root = sqrt(max(along * along - height, 0.0));
    return root - along > 0.0 ? height / (root - along) : 0.0;
}

/// Densities of air, aerosol and ozone.
vec3 densities(float altitude) {
    float at = clamp(altitude, 0.0, model.thickness) / model.density_step;
    int i = min(int(at), model.ln_density.length() - 2);
    return vec3(exp(mix(model.ln_density[i], model.ln_density[i + 1], at - float(i))),
                exp(-altitude / model.scale_height),
                max(1.0 - abs(altitude - model.ozone_tent.x) / model.ozone_tent.y, 0.0));
}

vec4 optical_depth(vec3 columns) {
    return model.rayleigh * columns.x + model.aerosol * columns.y + model.ozone * columns.z;
}

/// Share of the sun's disc above a line that its centre is `above`, radians.
float share_of_disc(float above) {
    float x = clamp(above / model.sun_radius, -1.0, 1.0);
    return 0.5 + (x * sqrt(max(1.0 - x * x, 0.0)) + asin(x)) / PI;
}

/// Transmittance from the sun times the share of its disc that is seen.
vec4 sun_through(float altitude, float sine) {
    float horizon = horizon_distance(altitude);
    float depression = horizon / (model.ground_radius + altitude);
    float above = (sine + depression) / sqrt(1.0 - depression * depression);
    if (above <= -model.sun_radius) return vec4(0.0);
    float top = horizon_distance(model.thickness);
    float least = model.thickness - altitude;
    float x = (distance_to_top(altitude, sine) - least) / (horizon + top - least);
    vec2 at = clamp(vec2(x, horizon / top), 0.0, 1.0) * vec2(model.depth_size - 1);
    ivec2 i = min(ivec2(at), model.depth_size - 2);
    vec2 f = at - vec2(i);
    int low = i.y * model.depth_size.x + i.x;
    int high = low + model.depth_size.x;
    vec4 depth = mix(mix(air.tables[low], air.tables[low + 1], f.x), mix(air.tables[high], air.tables[high + 1], f.x), f.y);
    return exp(-depth) * share_of_disc(above);
}

/// Column of the sine of the sun's elevation in the field, fractional.
float column_of(float sun_sine) {
    float least = model.sun_grid.x;
    float high = model.sun_grid.y;
    float slope = model.sun_grid.z;
    float low = float(model.low_steps);
    if (sun_sine <= high) return low * max((sun_sine - least) / (high - least), 0.0);
    float y = min((sun_sine - high) / (1.0 - high), 1.0);
    float x = 2.0 * y / (slope + sqrt(slope * slope + 4.0 * (1.0 - slope) * y));
    return low + (float(model.field_size.y - 1) - low) * x;
}

int field_start() {
    return model.depth_size.x * model.depth_size.y;
}

/// Irradiance of the ground by scattered light.
vec4 ground_irradiance(float sun_sine) {
    float column = column_of(sun_sine);
    int j = min(int(column), model.field_size.y - 2);
    int at = field_start() + model.field_size.x * model.field_size.y * COEFFICIENTS + j;
    return exp(mix(air.tables[at], air.tables[at + 1], column - float(j)));
}

/// Light scattered once more toward a direction.
vec4 scattered(float altitude, float sun_sine, float z, float cos_gamma, vec3 density) {
    float row = sqrt(clamp(altitude / model.thickness, 0.0, 1.0)) * float(model.field_size.x - 1);
    float column = column_of(sun_sine);
    ivec2 i = min(ivec2(row, column), model.field_size - 2);
    vec2 f = vec2(row, column) - vec2(i);
    int low = field_start() + (i.x * model.field_size.y + i.y) * COEFFICIENTS;
    int high = low + model.field_size.y * COEFFICIENTS;

    float across = sqrt(max(1.0 - sun_sine * sun_sine, 0.0));
    float horizontal = sqrt(max(1.0 - z * z, 0.0));
    float x = clamp((cos_gamma - z * sun_sine) / max(across, 1e-6), -horizontal, horizontal);
    float c = cos_gamma;
    float cc = c * c;
    float values[COEFFICIENTS] = float[](1.0, z, x, 3.0 * z * z - 1.0, x * z, 2.0 * x * x + z * z - 1.0,
        c * (2.5 * cc - 1.5), (cc * (35.0 * cc - 30.0) + 3.0) / 8.0, c * (cc * (63.0 * cc - 70.0) + 15.0) / 8.0,
        (cc * (cc * (231.0 * cc - 315.0) + 105.0) - 5.0) / 16.0);
    const int degrees[COEFFICIENTS] = int[](0, 1, 1, 2, 2, 2, 3, 4, 5, 6);

    vec4 rayleigh = model.rayleigh * density.x;
    vec4 aerosol = model.aerosol_scattering * density.y;
    vec4 sum = vec4(0.0);
    vec4 ln_mean = vec4(0.0);
    float moment = 1.0;
    int degree = 0;
    for (int k = 0; k < COEFFICIENTS; k++) {
        vec4 coefficient = mix(mix(air.tables[low + k], air.tables[low + COEFFICIENTS + k], f.y),
                               mix(air.tables[high + k], air.tables[high + COEFFICIENTS + k], f.y), f.x);
        if (degrees[k] > degree) {
            degree = degrees[k];
            moment *= model.asymmetry;
        }
        vec4 scattering = aerosol * moment;
        if (degree == 0) scattering += rayleigh;
        if (degree == 2) scattering += rayleigh * model.rayleigh_phase.z;
        if (k == 0) {
            ln_mean = coefficient;
            sum = scattering;
        } else {
            sum += scattering * coefficient * values[k];
        }
    }
    return max(exp(ln_mean) * sum, 0.0);
}

Path path_of(float altitude, float mu, float extent) {
    float lowest = clamp(-(model.ground_radius + altitude) * mu, 0.0, extent);
    return Path(altitude, mu, extent, lowest, -sqrt(lowest), sqrt(extent - lowest));
}

Point point_along(Path path, float t) {
    float r = model.ground_radius + path.altitude;
    float above = path.altitude * (2.0 * model.ground_radius + path.altitude) + t * (t + 2.0 * r * path.mu);
    float ground = model.ground_radius;
    float altitude = clamp(above / (sqrt(above + ground * ground) + ground), 0.0, model.thickness);
    float radius = ground + altitude;
    return Point(altitude, radius, clamp((r * path.mu + t) / radius, -1.0, 1.0));
}

/// Sine of the sun's elevation at a point of the path, from that at its start.
float sun_sine_along(Path path, float t, Point point, float sun_sine, float cos_gamma) {
    return clamp(((model.ground_radius + path.altitude) * sun_sine + t * cos_gamma) / point.radius, -1.0, 1.0);
}

vec4 mean_transmittance(vec4 x) {
    return mix((1.0 - exp(-x)) / max(x, 1e-9), 1.0 - x * (0.5 - x / 6.0), lessThan(x, vec4(1e-2)));
}

/// Light scattered at a point toward a direction, 1/(km sr) over the irradiance of the sun.
struct Source {
    vec4 rest;
    vec4 aerosol; // what the aerosol scatters once, over its phase function
};

Source source_at(Point point, vec3 density, float sun_sine, float cos_gamma) {
    vec4 sun = sun_through(point.altitude, sun_sine);
    float phase = model.rayleigh_phase.x + model.rayleigh_phase.y * cos_gamma * cos_gamma;
    return Source(model.rayleigh * (density.x * phase) * sun + scattered(point.altitude, sun_sine, point.mu, cos_gamma, density),
                  model.aerosol_scattering * density.y * sun);
}

/// Light scattered into a path, over the irradiance of the sun; `transmittance` is that of the path.
vec4 along(Path path, int cells, float sun_sine, float cos_gamma, out vec4 transmittance) {
    transmittance = vec4(1.0);
    if (path.extent == 0.0) return vec4(0.0);
    float phase = henyey_greenstein(model.asymmetry, cos_gamma);
    float width = (path.to - path.from) / float(cells);
    vec4 depth = vec4(0.0);
    vec4 light = vec4(0.0);
    for (int k = 0; k < cells; k++) {
        float a = path.from + width * float(k);
        float b = path.from + width * float(k + 1);
        float mean = (abs(b) * b * b - abs(a) * a * a) / max(3.0 * width, 1e-20);
        float t = clamp(path.lowest + mean, 0.0, path.extent);
        float span = b * abs(b) - a * abs(a);
        Point point = point_along(path, t);
        vec3 density = densities(point.altitude);
        vec4 own = optical_depth(density) * span;
        float sine = sun_sine_along(path, t, point, sun_sine, cos_gamma);
        Source source = source_at(point, density, sine, cos_gamma);
        light += exp(-depth) * mean_transmittance(own) * span * (source.rest + source.aerosol * phase);
        depth += own;
    }
    transmittance = exp(-depth);
    return light;
}

/// Radiance of the ground.
vec4 ground_radiance(float sun_sine) {
    vec4 direct = sun_through(0.0, sun_sine) * max(sun_sine, 0.0);
    return (direct + ground_irradiance(sun_sine)) * (model.ground_albedo / PI);
}

/// Radiance in a direction whose path meets the ground or leaves the air, over the irradiance of the sun.
vec4 transfer(float altitude, float mu, float sun_sine, float cos_gamma, bool meets_ground) {
    Path path = path_of(altitude, mu, meets_ground ? distance_to_ground(altitude, mu) : distance_to_top(altitude, mu));
    vec4 transmittance;
    vec4 light = along(path, meets_ground ? model.ground_cells : model.cells, sun_sine, cos_gamma, transmittance);
    if (!meets_ground) return light;
    Point ground = point_along(path, path.extent);
    float sine = sun_sine_along(path, path.extent, ground, sun_sine, cos_gamma);
    return light + transmittance * ground_radiance(sine);
}

/// kcd/m^2, not clipped.
vec3 rgb_of(vec4 transfer) {
    return model.rgb[0] * transfer.x + model.rgb[1] * transfer.y + model.rgb[2] * transfer.z + model.rgb[3] * transfer.w;
}
