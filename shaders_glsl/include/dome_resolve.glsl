// Resolves the means: sky light, corrected by the ratio of the exact to the sampled unoccluded sky, plus all other light.

layout(constant_id = 0) const bool ILLUMINANCE = false;

layout(set = 0, binding = 0) uniform sampler2D sky;
layout(set = 0, binding = 1) uniform sampler2D rest;
layout(set = 0, binding = 2) uniform sampler2D illuminance; // with ILLUMINANCE; else any

/// The picture; `at`: the pixel's centre. rgb: kcd/m^2, or the quantity shown; a: with ILLUMINANCE, that of the surface, klx.
vec4 resolved(vec2 at) {
    vec2 uv = at / vec2(textureSize(sky, 0));
    vec4 visible = textureLod(sky, uv, 0.0);
    vec4 other = textureLod(rest, uv, 0.0);
    vec3 light = visible.a > 0.0 ? visible.rgb * (other.a / visible.a) : vec3(0.0);
    float lux = 0.0;
    if (ILLUMINANCE) {
        // From the sky, with the same correction, and from the sun.
        vec4 e = textureLod(illuminance, uv, 0.0);
        lux = (e.y > 0.0 ? e.x * e.z / e.y : 0.0) + e.w;
    }
    return vec4(light + other.rgb, lux);
}
