// Occluders overhead, on screen or not: depth as seen from the zenith. Included by ssao.frag after its declarations.

layout(set = 0, binding = 3) uniform sampler2D height_map; // reversed depth: 1 is highest, 0 is empty
layout(set = 0, binding = 4, scalar) uniform HeightMap {
    mat4 from_view; // view space to the map's clip space
    float lift;     // normal offset of a point, metres
    float slack;    // depth by which a point must be below the map to be under a roof
    int rays;       // per slice; 0 if the map is too coarse
} height;

const int RAY_STEPS = 2;

/// Depth of the highest surface at a point of the map's clip space.
float highest(vec3 at) {
    return textureLod(height_map, at.xy * 0.5 + 0.5, 0.0).r;
}

/// Whether a ray from a point under a roof hits the roof from below. `top` is the roof's depth above the point. Each step assumes
/// a level roof at the height found at the previous step.
bool meets_roof(vec3 from, float top, vec3 step, float jitter) {
    vec3 last = from;
    bool blocked = false;
    for (int i = 0; i < RAY_STEPS; ++i) {
        vec3 at = from + step * (float(i) + 0.5 + 0.5 * jitter);
        vec3 met = mix(last, at, clamp((top - last.z) / max(at.z - last.z, 1e-9), 0.0, 1.0));
        // Where the map is empty, its depth is 0.
        blocked = blocked || (last.z <= top && top < at.z && highest(met) > max(last.z, 0.0));
        top = highest(at);
        last = at;
    }
    return blocked;
}

/// Sectors of one side up to a direction of the slice (along the axis, along the view direction, unit); none on the other side.
float sectors_up_to(vec2 direction, Side side) {
    return direction.x > 0.0 ? weight(direction.y, side.n) * side.per_weight : 0.0;
}

/// The unit direction in a slice whose angle to the slice's normal has this sine (along the axis, along the view direction).
vec2 slice_direction(vec2 slice_n, float sine) {
    return slice_n * sqrt(max(1.0 - sine * sine, 0.0)) + vec2(slice_n.y, -slice_n.x) * sine;
}

/// The sectors of both sides that a roof blocks: rays fan out from points under a roof.
uvec2 roofed_sectors(Side plus, Side minus, float jitter, float dither) {
    vec3 from = (height.from_view * vec4(p + n * height.lift, 1.0)).xyz;
    // No rays are computed for groups of pixels that are all in the open.
    float top = highest(from);
    int rays = top > from.z + height.slack ? height.rays : 0;
    // Uniform in the sine of the angle to the normal, between the tangents: equal cosine weights.
    vec2 low = slice_direction(plus.n, -1.0);
    uvec2 sectors = uvec2(0u);
    for (int i = 0; i < rays; ++i) {
        float width = 2.0 / float(rays);
        float sine = width * float(i + 1) - 1.0;
        vec2 high = slice_direction(plus.n, sine);
        vec2 middle = slice_direction(plus.n, sine - width * dither);
        vec3 step = (plus.axis * middle.x + v * middle.y) * (push.radius / float(RAY_STEPS));
        if (meets_roof(from, top, mat3(height.from_view) * step, jitter)) {
            sectors.x |= between(sectors_up_to(low, plus), sectors_up_to(high, plus), dither);
            vec2 mirrored = vec2(-1.0, 1.0);
            sectors.y |= between(sectors_up_to(low * mirrored, minus), sectors_up_to(high * mirrored, minus), dither);
        }
        low = high;
    }
    return sectors;
}
