// The air between the eye and a surface, from the table of daylight::atmosphere::aerial: seen = transmittance radiance + inscatter.
#include "air_rays.glsl"
#include "colour.glsl"
#include "filtered.glsl"

layout(set = 0, binding = 13, scalar) uniform Air {
    vec4 rayleigh; // optical depths of a km of air, of aerosol and of ozone at their reference densities, at the four wavelengths
    vec4 aerosol;
    vec4 ozone;
    vec3 transmittance[4]; // BT.709 transmittance of sunlight by that of each wavelength
    vec3 inscatter[4];     // radiance, kcd/m^2, of a transfer of 1 at each wavelength
    vec3 veil;             // radiance that clouds and the night scatter into an endless ray, kcd/m^2
    vec3 sun;              // unit, toward the true sun
    vec2 toward_sun;       // unit, horizontal (x, z)
    float altitude;        // see Rays
    float ceiling;
    float horizon;
    float ground_radius;
    float asymmetry; // of the aerosol
    ivec4 sizes;     // of the table: azimuths, rows of sources, rows of densities (each half of them), steps
} air;

/// Rows of sources without, then with the aerosol; each has the azimuths of one step after those of another. Below, the mean densities:
/// a column is a row of them, a row a step.
layout(set = 0, binding = 14) uniform sampler2D air_table;

/// Row of an elevation, fractional; never between the halves above and below the horizon.
float air_row(float sine, bool meets_ground, int rows) {
    float horizon = meets_ground ? -air.horizon : air.horizon;
    float s = meets_ground ? -sine : sine;
    float root = sqrt(1.0 - horizon);
    float height = (s - horizon) / (root + sqrt(max(1.0 - s, 0.0)));
    float row = sqrt(clamp(height / root, 0.0, 1.0)) * float(rows - 1);
    return meets_ground ? row + float(rows) : row;
}

vec4 air_texel(vec2 at) {
    return filtered(air_table, at);
}

struct AirRay {
    bool meets_ground;
    float step;         // where the surface is, fractional
    vec4 transmittance; // at the four wavelengths
};

AirRay air_ray(vec3 direction, float km) {
    Rays rays = Rays(air.altitude, air.ceiling, air.horizon, air.ground_radius);
    bool meets_ground = direction.y < air.horizon;
    float whole = ray_length(rays, direction.y, meets_ground);
    float distance = min(km, whole);
    float share = distance / max(whole, 1e-6);
    float step = float(air.sizes.w - 1) * (meets_ground ? 1.0 - sqrt(max(1.0 - share, 0.0)) : sqrt(share));
    vec3 density = air_texel(vec2(air_row(direction.y, meets_ground, air.sizes.z), float(4 * air.sizes.y) + step)).xyz;
    vec4 depth = (air.rayleigh * density.x + air.aerosol * density.y + air.ozone * density.z) * distance;
    return AirRay(meets_ground, step, exp(-depth));
}

/// Not negative.
vec3 air_transmittance(AirRay ray) {
    vec4 t = ray.transmittance;
    return max(air.transmittance[0] * t.x + air.transmittance[1] * t.y + air.transmittance[2] * t.z + air.transmittance[3] * t.w, 0.0);
}

/// Light scattered on the way, kcd/m^2, not negative.
vec3 air_inscatter(AirRay ray, vec3 direction) {
    float row = air_row(direction.y, ray.meets_ground, air.sizes.y);
    float cosine = dot(direction.xz, air.toward_sun) * inversesqrt(max(dot(direction.xz, direction.xz), 1e-20));
    float from_middle = 1.0 - sqrt(max(1.0 - abs(cosine), 0.0));
    float entry = 0.5 * (cosine < 0.0 ? 1.0 - from_middle : 1.0 + from_middle) * float(air.sizes.x - 1);
    float step = min(floor(ray.step), float(air.sizes.w - 2));
    vec2 at = vec2(step * float(air.sizes.x) + entry, row);
    vec2 next = vec2(air.sizes.x, 0);
    vec2 aerosol = vec2(0, 2 * air.sizes.y);
    float share = ray.step - step;
    float phase = henyey_greenstein(air.asymmetry, dot(direction, air.sun));
    vec4 source = mix(air_texel(at), air_texel(at + next), share)
                + mix(air_texel(at + aerosol), air_texel(at + aerosol + next), share) * phase;
    vec4 light = source * (1.0 - ray.transmittance);
    vec3 sunlight = air.inscatter[0] * light.x + air.inscatter[1] * light.y + air.inscatter[2] * light.z + air.inscatter[3] * light.w;
    return clip_negative(sunlight) + (1.0 - air_transmittance(ray)) * air.veil;
}
