#version 460

// Resolves the means: sky light, corrected by the ratio of the exact to the sampled unoccluded sky, plus all other light.

layout(location = 0) out vec4 radiance; // rgb: kcd/m^2, or the quantity shown; a: with ILLUMINANCE, that of the surface, klx

layout(constant_id = 0) const bool ILLUMINANCE = false;

layout(set = 0, binding = 0) uniform sampler2D sky;
layout(set = 0, binding = 1) uniform sampler2D rest;
layout(set = 0, binding = 2) uniform sampler2D illuminance; // with ILLUMINANCE; else any

void main() {
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(sky, 0));
    vec4 visible = textureLod(sky, uv, 0.0);
    vec4 other = textureLod(rest, uv, 0.0);
    vec3 light = visible.a > 0.0 ? visible.rgb * (other.a / visible.a) : vec3(0.0);
    float lux = 0.0;
    if (ILLUMINANCE) {
        // From the sky, with the same correction, and from the sun.
        vec4 e = textureLod(illuminance, uv, 0.0);
        lux = (e.y > 0.0 ? e.x * e.z / e.y : 0.0) + e.w;
    }
    radiance = vec4(light + other.rgb, lux);
}
