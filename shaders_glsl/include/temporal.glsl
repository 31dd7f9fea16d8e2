#include "display_values.glsl"

// Temporal anti-aliasing of display values: each frame samples another point of the pixels, and the picture before, moved along with the
// camera, adds the samples of the frames before (Karis 2014, "High Quality Temporal Supersampling"). Display values are between 0 and
// white, so that no single bright sample decides a pixel.
//
// The scene stands still, so the motion of a pixel follows from its depth alone, and so does whether the picture before shows the same surface
// there: else it does not count. A linear lookup between texels blurs, and each frame would blur again: in turn along x and y it is sharpened
// by what it lost, and the more a frame loses, the fewer frames count. As long as the light is the same too, it needs no bounds: those that others take from the pixels
// around would cut off thin parts, which most frames miss, and let them flicker.

// The light is not that of the picture before, which is bounded by what is around the pixel now.
layout(constant_id = 0) const bool BOUNDED = false;

layout(set = 0, binding = 0) uniform sampler2D display;      // this frame, display values; a: 1 if exposed as the frame before
layout(set = 0, binding = 1) uniform sampler2D depth;        // of this frame: near / distance
layout(set = 0, binding = 2) uniform sampler2D before;       // the picture before
layout(set = 0, binding = 3) uniform sampler2D depth_before;

layout(push_constant, scalar) uniform Push {
    vec4 to_u;       // from (pixel, depth, 1) to u of the picture before, times w
    vec4 to_v;
    vec4 to_w;
    vec2 half_texel; // of the picture, in u and v
    float to_depth;  // from depth to that of the picture before, times w
    float same;      // largest difference in depth before of one and the same surface; negative: none is
    float shift;     // of the rounding, 0..1: another one for every frame
    vec2 jitter;     // of the frame before, in u and v
    vec2 axis;       // along which the picture before is sharpened: that of x or of y
} push;

/// Added to the number of frames where surfaces that move apart meet.
const float EDGE = 128.0;

/// Frames that count in a picture before with another light or exposure.
const float FEW = 2.0;

/// Variance by which the frames in a mean may spread a texel, of both axes together, pixels^2. More of it would show as blur, less leaves too few
/// samples in the mean.
const float SPREAD = 2.0;

/// More than rounding to 8 bits makes of `lost` below: half a step four times where the picture was stored, and as much again where it is looked up.
const float NOISE = 4.5 / 255.0;

/// The picture before within the values around the pixel.
vec3 bounded(vec3 old, vec3 now, ivec2 pixel) {
    const ivec2 sides[4] = ivec2[4](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));
    vec3 least = now, most = now;
    for (int i = 0; i < 4; ++i) {
        ivec2 beside = clamp(pixel + sides[i], ivec2(0), textureSize(display, 0) - 1);
        vec3 c = texelFetch(display, beside, 0).rgb;
        least = min(least, c);
        most = max(most, c);
    }
    return clamp(old, least, most);
}

/// The picture before between its texels. A linear lookup at the fraction f between two texels adds f (1 - f) / 2 of the second derivative along each
/// axis. Twice this is taken away along one of them, so that two frames together are exact to the third order. Beside an edge nothing is
/// brighter or darker than what is there; a thin line stands out at most twice as much as in the linear lookup. What may be noise of the rounding stays.
/// `spread`: f (1 - f) along each axis.
vec3 sharpened(vec2 at, vec2 spread) {
    vec2 texel = push.axis * 2.0 * push.half_texel;
    vec3 old = textureLod(before, at, 0.0).rgb;
    vec3 a = textureLod(before, at - texel, 0.0).rgb, b = textureLod(before, at + texel, 0.0).rgb;
    vec3 least = min(a, b), most = max(a, b), twice = 2.0 * old;
    vec3 lost = twice - a - b;
    if (!LINEAR) lost *= step(NOISE, abs(lost));
    vec3 sharp = old + dot(spread, push.axis) * lost;
    return clamp(sharp, max(min(least, twice - least), 0.0), max(most, twice - most));
}

/// The mean with this frame at a pixel. rgb: display values; a: number of frames in it, of FRAMES, and EDGE more at edges.
vec4 smoothed(vec2 centre_of_pixel) {
    ivec2 pixel = ivec2(centre_of_pixel);
    vec4 shown = texelFetch(display, pixel, 0);
    vec3 now = shown.rgb;

    // The nearest surface around: the edge of what is in front moves with it. At an edge the frame before may have met either surface.
    vec2 centre = centre_of_pixel * 2.0;
    vec4 above = textureGather(depth, (centre - 1.0) * push.half_texel), below = textureGather(depth, (centre + 1.0) * push.half_texel);
    vec4 near = max(above, below), far = min(above, below);
    float nearest = max(max(near.x, near.y), max(near.z, near.w)), farthest = min(min(far.x, far.y), min(far.z, far.w));

    vec4 here = vec4(centre_of_pixel, nearest, 1.0);
    float over_w = 1.0 / dot(push.to_w, here);
    vec2 at = vec2(dot(push.to_u, here), dot(push.to_v, here)) * over_w;
    float expected = push.to_depth * nearest * over_w, found = textureLod(depth_before, at - push.jitter, 0.0).r;
    float differs = max(found - expected, expected + farthest - nearest - found);
    vec2 aside = abs(at - 0.5);
    bool is_same = differs <= push.same && max(aside.x, aside.y) < 0.5;

    // A pixel at an edge mixes two surfaces that move apart: where there is no edge now, the mean of such pixels does not count.
    // Its mark is that of one texel: between two it would mean nothing.
    vec2 place = at * 0.5 / push.half_texel; // pixels
    ivec2 texel = clamp(ivec2(place), ivec2(0), textureSize(before, 0) - 1);
    float mark = texelFetch(before, texel, 0).a * FRAMES;
    bool is_edge = push.same >= 0.0 && nearest - farthest > push.same, was_edge = mark > MOST_FRAMES + 0.5;
    // A linear lookup spreads a texel by the variance f (1 - f) along each axis, pixels^2. That of all frames in the mean stays below SPREAD.
    vec2 f = fract(place - 0.5), spread = f - f * f;
    float frames = SPREAD / (spread.x + spread.y + SPREAD / MOST_FRAMES);
    float most = BOUNDED || shown.a < 0.5 ? FEW : frames - 1.0;
    float count = is_same && (is_edge || !was_edge) ? min(mark < EDGE ? mark : mark - EDGE, most) : 0.0;
    vec3 old = sharpened(at, spread);
    if (BOUNDED) old = bounded(old, now, pixel);
    // A picture before that does not count may be undefined.
    vec3 mean = light_of_display(now);
    if (count > 0.0) mean = mix(light_of_display(old), mean, 1.0 / (count + 1.0));
    return vec4(rounded(display_of_light(mean), centre_of_pixel, push.shift), (count + 1.0 + (is_edge ? EDGE : 0.0)) / FRAMES);
}
