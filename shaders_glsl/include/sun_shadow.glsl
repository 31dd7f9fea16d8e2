// The sun's shadow beyond one map: cascades for large scenes, and penumbrae as wide as the sun's disc makes them.
// Needs `shadow_map`, `sun`, `view`, CASCADES and PCSS.

layout(set = 0, binding = 11, scalar) uniform Cascades {
    mat4 from_world[4]; // the finest first; their maps lie side by side
    vec4 sizes[4];      // metres: from the eye to the sides of the cube it covers, a texel, a unit of depth; unused
    float tan_radius;   // of the sun's disc
} cascades;

// On discs whose points are spread evenly: looking for blockers, and comparing.
const int BLOCKER_TAPS = 24;
const int FILTER_TAPS = 48;
// Largest radius of the search, texels: taps farther apart than these are miss thin things.
const float WIDEST = 48.0;

/// A receiver in the map of cascade k.
struct Receiver {
    vec2 at;     // texels
    float depth;
    vec2 slope;  // of its plane: depth for a texel
    int k;
    int edge;    // of the map, texels
};

float map_depth(Receiver r, ivec2 texel) {
    return texelFetch(shadow_map, clamp(texel, ivec2(0), ivec2(r.edge - 1)) + ivec2(r.k * r.edge, 0), 0).r;
}

/// A bilinear comparison at an offset (texels) with the plane of the receiver: 1 is lit.
float lit_at(Receiver r, vec2 offset) {
    vec2 at = r.at + offset - 0.5;
    ivec2 base = ivec2(floor(at));
    vec2 f = at - vec2(base);
    vec4 maps = vec4(map_depth(r, base), map_depth(r, base + ivec2(1, 0)),
                     map_depth(r, base + ivec2(0, 1)), map_depth(r, base + ivec2(1, 1)));
    // Behind all casters, and beside them, the map is empty: depth 0.
    vec4 lit = step(maps, vec4(max(r.depth + dot(r.slope, offset), 0.0)));
    return mix(mix(lit.x, lit.y, f.x), mix(lit.z, lit.w, f.x), f.y);
}

/// The mean of four comparisons half a texel apart, as of a single map.
float tent(Receiver r) {
    r.slope = vec2(0.0);
    return 0.25 * (lit_at(r, vec2(-0.5, -0.5)) + lit_at(r, vec2(0.5, -0.5)) +
                   lit_at(r, vec2(-0.5, 0.5)) + lit_at(r, vec2(0.5, 0.5)));
}

/// Point i of n of the unit disc (Vogel 1979: the golden angle, equal areas).
vec2 on_disc(int i, int n) {
    float angle = float(i) * 2.39996323;
    return sqrt((float(i) + 0.5) / float(n)) * vec2(cos(angle), sin(angle));
}

/// Fernando 2005, "Percentage-Closer Soft Shadows", for a disc infinitely far away: the penumbra of a blocker at a distance d
/// is 2 tan(radius) d wide, and V is the share of the disc that is seen past it.
float penumbra(Receiver r, float texel, float depth_metres) {
    float tan_texels = cascades.tan_radius * depth_metres / texel;
    float search = clamp(tan_texels * (1.0 - r.depth), 1.0, WIDEST);
    float sum = 0.0, blockers = 0.0;
    for (int i = 0; i < BLOCKER_TAPS; ++i) {
        vec2 offset = on_disc(i, BLOCKER_TAPS) * search;
        float above = map_depth(r, ivec2(floor(r.at + offset))) - (r.depth + dot(r.slope, offset));
        if (above > 0.0) { sum += above; blockers += 1.0; }
    }
    if (blockers == 0.0) return 1.0;
    if (blockers == float(BLOCKER_TAPS)) return 0.0;
    float radius = clamp(tan_texels * sum / blockers, 0.75, WIDEST);
    float lit = 0.0;
    for (int i = 0; i < FILTER_TAPS; ++i) lit += lit_at(r, on_disc(i, FILTER_TAPS) * radius);
    return lit / float(FILTER_TAPS);
}

float in_cascade(int k, vec3 world, vec3 n, float n_dot_l) {
    float texel = cascades.sizes[k].y;
    float depth_metres = cascades.sizes[k].z;
    float sine = max(sqrt(max(1.0 - n_dot_l * n_dot_l, 0.0)), 0.1);
    mat4 map = cascades.from_world[k];
    vec3 p = (map * vec4(world + n * (1.5 * texel * sine), 1.0)).xyz;
    int edge = textureSize(shadow_map, 0).y;
    // Right and up of the map, in the world: its rows, without their scale.
    float scale = 0.5 * float(edge) * texel;
    vec2 across = vec2(dot(vec3(map[0][0], map[1][0], map[2][0]), n), dot(vec3(map[0][1], map[1][1], map[2][1]), n)) * scale;
    vec2 slope = -across / max(n_dot_l, 0.1) * (texel / depth_metres);
    Receiver r = Receiver((p.xy * 0.5 + 0.5) * float(edge), p.z, slope, k, edge);
    return PCSS ? penumbra(r, texel, depth_metres) : tent(r);
}

/// V by the finest map that has the point, blended into the next toward the end of its cube.
float sun_visibility(vec3 world, vec3 n, float n_dot_l) {
    vec3 away = abs(world - view.eye);
    float reach = max(away.x, max(away.y, away.z));
    int k = 0;
    for (int i = 0; i < CASCADES - 1; ++i) if (reach >= cascades.sizes[i].x) k = i + 1;
    float V = in_cascade(k, world, n, n_dot_l);
    if (k + 1 < CASCADES) {
        float blend = (reach / cascades.sizes[k].x - 0.85) / 0.15;
        if (blend > 0.0) V = mix(V, in_cascade(k + 1, world, n, n_dot_l), blend);
    }
    return V;
}
