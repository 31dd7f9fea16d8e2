// Common to all sky models: twilight, night, clouds, ground and gamut clipping, as in `daylight::sky` on the CPU.
#include "colour.glsl"
#include "cube.glsl"

layout(push_constant, scalar) uniform Push {
    vec3 sun_direction; // unit, toward the sun that the model is evaluated for
    float scale;        // fade through twilight
    vec3 night;         // added radiance, kcd/m^2
    vec3 ground;        // radiance below the horizon, kcd/m^2
    float clouds;       // luminance of clouds at the zenith, kcd/m^2
} push;

// Closer to the horizon than this, exp(B / cos theta) is lost in float32; the texel centres of a cube stay above it.
const float MIN_COS_THETA = 1e-4;

/// Angle between two unit vectors (Kahan): acos loses half of its digits near 0, where the sky is brightest.
float angle_between(vec3 a, vec3 b) {
    return 2.0 * atan(length(a - b), length(a + b));
}

/// Radiance of the sky, or of the ground below the horizon, kcd/m^2. `model` is the model's radiance.
vec4 guarded(vec3 direction, vec3 model) {
    if (direction.y <= 0.0) return vec4(push.ground, 1.0);
    float clouds = push.clouds * (1.0 + 2.0 * direction.y) / 3.0;
    return vec4(clip_negative(model) * push.scale + push.night + clouds, 1.0);
}
