#include "colour.glsl"

// Maps of colours: polynomial fits of sRGB values, decoded. The CPU has the sources: daylight/false_colour.rs.
const int TURBO = 0;
const int VIRIDIS = 1;
const int CIVIDIS = 2;

vec3 turbo(float x) {
    vec3 c = vec3(59.28637943, 2.82956604, 27.34824973);
    c = c * x + vec3(-152.94239396, 4.27729857, -89.90310912);
    c = c * x + vec3(132.13108234, -14.18503333, 110.36276771);
    c = c * x + vec3(-42.66032258, 4.84296658, -60.58204836);
    c = c * x + vec3(4.61539260, 2.19418839, 12.64194608);
    return c * x + vec3(0.13572138, 0.09140261, 0.10667330);
}

vec3 viridis(float x) {
    vec3 c = vec3(-5.43207717, 4.64157132, 26.27210760);
    c = c * x + vec3(4.75178689, -13.74943940, -65.32096783);
    c = c * x + vec3(6.20373590, 14.15396495, 56.65629957);
    c = c * x + vec3(-4.59993152, -5.75823819, -19.29180895);
    c = c * x + vec3(-0.32724110, 0.21481356, 0.09197688);
    c = c * x + vec3(0.10770833, 1.39646968, 1.38677060);
    return c * x + vec3(0.27445542, 0.00576796, 0.33266388);
}

vec3 cividis(float x) {
    vec3 c = vec3(25.77607014, 0.68812232, -28.26253302);
    c = c * x + vec3(-83.18723896, -2.14075039, 93.97421640);
    c = c * x + vec3(102.37049151, 2.60091430, -121.30316422);
    c = c * x + vec3(-58.97703146, -1.40419712, 74.86356110);
    c = c * x + vec3(15.42921035, 0.38556165, -22.36376037);
    c = c * x + vec3(-0.38468905, 0.63949370, 2.98265393);
    return c * x + vec3(-0.00897344, 0.13675589, 0.29417019);
}

/// The linear colour at x, 0..1, of a map.
vec3 mapped_colour(int map, float x) {
    vec3 c = map == VIRIDIS ? viridis(x) : map == CIVIDIS ? cividis(x) : turbo(x);
    return linear_from_srgb(clamp(c, 0.0, 1.0));
}
