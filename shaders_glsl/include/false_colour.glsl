#include "colour.glsl"

/// Mikhailov 2019, "Turbo, An Improved Rainbow Colormap for Visualization": polynomial fit of the sRGB values, decoded.
vec3 turbo(float x) {
    vec3 c = vec3(59.28637943, 2.82956604, 27.34824973);
    c = c * x + vec3(-152.94239396, 4.27729857, -89.90310912);
    c = c * x + vec3(132.13108234, -14.18503333, 110.36276771);
    c = c * x + vec3(-42.66032258, 4.84296658, -60.58204836);
    c = c * x + vec3(4.61539260, 2.19418839, 12.64194608);
    c = c * x + vec3(0.13572138, 0.09140261, 0.10667330);
    return linear_from_srgb(clamp(c, 0.0, 1.0));
}
