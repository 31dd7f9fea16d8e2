// The sky of daylight::atmosphere, from the tables of the whole view under the sun and under the moon.
#include "constants.glsl"
#include "sky.glsl"

// Whether there is a moon that counts. A software device would compute both sides of a branch.
layout(constant_id = 0) const bool MOON = false;

layout(set = 0, binding = 0, scalar) uniform Model {
    vec2 toward_sun;    // horizontal (x, z)
    vec2 toward_moon;
    float moon_share;   // illuminance of the moon outside the air over the sun's
    float horizon;      // elevation of the horizon of the ground, radians
    float ground_scale; // what clouds leave of the light of the ground
} model;

layout(set = 0, binding = 1) uniform sampler2D sky_view;  // kcd/m^2, not clipped
layout(set = 0, binding = 2) uniform sampler2D moon_view; // the same under a sun in the place of the moon

/// Entry and row, fractional, of a direction; the row is never between the halves above and below the horizon.
vec2 coordinates(vec3 direction, vec2 toward, ivec2 size) {
    vec2 horizontal = direction.xz;
    float across = abs(toward.x * horizontal.y - toward.y * horizontal.x);
    float azimuth = atan(across, dot(toward, horizontal));
    float above = atan(direction.y, length(horizontal)) - model.horizon;
    float reach = above >= 0.0 ? 0.5 * PI - model.horizon : 0.5 * PI + model.horizon;
    vec2 share = sqrt(clamp(vec2(azimuth / PI, abs(above) / reach), 0.0, 1.0));
    int half_height = size.y / 2;
    return share * vec2(size.x - 1, half_height - 1) + vec2(0.0, above >= 0.0 ? 0 : half_height);
}

vec3 view(sampler2D table, vec3 direction, vec2 toward, out bool is_ground) {
    ivec2 size = textureSize(table, 0);
    vec2 at = coordinates(direction, toward, size);
    ivec2 i = min(ivec2(at), size - 2);
    vec2 f = at - vec2(i);
    is_ground = at.y >= float(size.y / 2);
    vec3 low = mix(texelFetch(table, i, 0).rgb, texelFetch(table, i + ivec2(1, 0), 0).rgb, f.x);
    vec3 high = mix(texelFetch(table, i + ivec2(0, 1), 0).rgb, texelFetch(table, i + ivec2(1, 1), 0).rgb, f.x);
    return mix(low, high, f.y);
}

/// Radiance of the sky in a unit direction, kcd/m^2. `push.ground` is what the ground has besides the light of this sky.
vec4 sky(vec3 direction) {
    bool is_ground;
    vec3 radiance = view(sky_view, direction, model.toward_sun, is_ground);
    if (MOON) radiance += view(moon_view, direction, model.toward_moon, is_ground) * model.moon_share;
    radiance = clip_negative(radiance);
    if (is_ground) return vec4(radiance * model.ground_scale + push.ground, 1.0);
    float clouds = push.clouds * (1.0 + 2.0 * max(direction.y, 0.0)) / 3.0;
    return vec4(radiance * push.scale + push.night + clouds, 1.0);
}
