// Specular lobes: the lecture's (r.w)^p, and its energy-conserving form.
#include "frame.glsl"
#include "filtered.glsl"

/// Lewis 1994, "Making Shaders More Physically Plausible": with this factor (and the cosine of the incoming light, which the
/// lecture's form omits) the lobe reflects the fraction rho_s of light at normal incidence, and never more.
float phong_scale(float p) {
    return (p + 2.0) / (2.0 * PI);
}

/// Fresnel approximation of rho_s (Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering"). The limit at grazing
/// angles is (1 - roughness)^2, or rho_s if larger; roughness follows from p by the rule that materials use.
vec3 grazing(vec3 rho_s, float shininess, float cosine) {
    float smoothness = 1.0 - pow(2.0 / (shininess + 2.0), 0.25);
    vec3 most = max(vec3(smoothness * smoothness), rho_s);
    return mix(rho_s, most, pow(clamp(1.0 - cosine, 0.0, 1.0), 5.0));
}

const int LOBE_SAMPLES = 16;

/// Integral of the unoccluded sky over the normalized lobe around r of a surface with normal n. Importance sampled by the lobe,
/// (p+1)/(2 pi) (r.w)^p, on a Fibonacci lattice; `shift` (0..1) offsets it from frame to frame.
vec3 sky_in_lobe(samplerCube sky, vec3 r, vec3 n, float p, vec2 shift) {
    mat3 frame = frame_from_normal(r);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < LOBE_SAMPLES; ++i) {
        vec2 xi = fract(shift + (float(i) + 0.5) * vec2(1.0 / float(LOBE_SAMPLES), 0.6180339887));
        float cosine = pow(max(xi.x, 1e-6), 1.0 / (p + 1.0));
        float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
        vec3 w = frame * vec3(sine * cos(2.0 * PI * xi.y), sine * sin(2.0 * PI * xi.y), cosine);
        sum += max(dot(n, w), 0.0) * filtered(sky, w, 0.0).rgb;
    }
    return sum * ((p + 2.0) / ((p + 1.0) * float(LOBE_SAMPLES)));
}
