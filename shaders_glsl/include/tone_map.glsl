#include "colour.glsl"
#include "tone_curve.glsl"
#include "false_colour.glsl"
#include "dither.glsl"
#include "hdr.glsl"

// Radiance to display values.

// At most one curve is set; with none the scale is linear, as in the lecture.
layout(constant_id = 0) const bool EXPONENTIAL = false;
layout(constant_id = 1) const bool REINHARD = false;
layout(constant_id = 2) const bool AGX = false;
layout(constant_id = 3) const bool NEUTRAL = false;
layout(constant_id = 4) const bool ACES = false;
// At most one encoding is set.
layout(constant_id = 5) const bool GAMMA = false;
layout(constant_id = 11) const bool SRGB = false;
// Exposure from the average luminance instead of the push constant.
layout(constant_id = 6) const bool AUTO = false;
// Ferschin's curve on luminance.
layout(constant_id = 8) const bool EXPONENTIAL_LUMINANCE = false;
// Show the luminance in grey.
layout(constant_id = 7) const bool GREY = false;
// Dither for 8 bits.
layout(constant_id = 10) const bool DITHER = false;
// Show false colours of the luminance instead of exposure and curve.
layout(constant_id = 9) const bool FALSE_COLOUR = false;
layout(constant_id = 12) const int COLOUR_MAP = TURBO;
// On a linear scale from 0 instead of a logarithmic one.
layout(constant_id = 14) const bool EVEN = false;
// Up to the peak of an HDR screen instead of a tone curve.
layout(constant_id = 13) const bool HDR = false;

layout(set = 0, binding = 0) uniform sampler2D radiance;          // kcd/m^2
layout(set = 0, binding = 1) uniform sampler2D average_luminance; // one texel; r: kcd/m^2; g: over that of the picture before

layout(push_constant, scalar) uniform Push {
    float exposure;      // display units for 1 kcd/m^2; with AUTO the display value of the average luminance;
                         // with FALSE_COLOUR the fraction of the range per factor of 2
    float offset;        // added after the scale: shows signed quantities; with FALSE_COLOUR the position of 1 kcd/m^2 (1 klx)
    float white;         // Reinhard's white, display units
    float inverse_gamma; // of the power
    float least;         // with AUTO: the lowest average luminance that is exposed for, kcd/m^2
    float peak;          // with HDR: highest display value of the screen
    uvec2 origin;        // of this tile in the picture, pixels
} push;

/// Change of the exposure up to which pictures may be added up.
const float EXPOSED = 0.02;

/// The display value of a pixel; `at`: its centre. a: 0 if the exposure is not nearly that of the picture before.
vec4 shown(vec2 at) {
    vec3 c = textureLod(radiance, at / vec2(textureSize(radiance, 0)), 0.0).rgb;
    if (FALSE_COLOUR) {
        float l = luminance(c);
        float value = EVEN ? l : log2(max(l, 1e-30));
        float share = clamp(value * push.exposure + push.offset, 0.0, 1.0);
        bool is_on_scale = EVEN ? l >= 0.0 : l > 0.0;
        vec3 colour = is_on_scale ? mapped_colour(COLOUR_MAP, share) : vec3(0.0);
        return vec4(SRGB ? srgb_from_linear(colour) : colour, 1.0);
    }
    float exposure = push.exposure;
    float alike = 1.0;
    if (AUTO) {
        vec2 average = textureLod(average_luminance, vec2(0.5), 0.0).rg;
        exposure /= max(average.r, push.least);
        alike = abs(average.g - 1.0) > EXPOSED ? 0.0 : 1.0;
    }
    if (GREY) c = vec3(luminance(c));
    c = max(c * exposure + push.offset, 0.0);
    if (EXPONENTIAL) c = tone_exponential(c);
    if (EXPONENTIAL_LUMINANCE) c = tone_exponential_luminance(c);
    if (REINHARD) c = tone_reinhard(c, push.white);
    if (AGX) c = tone_agx(c);
    if (NEUTRAL) c = tone_neutral(c);
    if (ACES) c = tone_aces(c);
    c = HDR ? bounded(c, push.peak) : clamp(c, 0.0, 1.0);
    if (GAMMA) c = pow(c, vec3(push.inverse_gamma));
    if (SRGB) c = srgb_from_linear(c);
    if (DITHER) c = dithered(c, uvec2(at) + push.origin, 255.0);
    return vec4(c, alike);
}
