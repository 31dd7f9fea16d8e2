// The sun's shadow: one map, cascades for large scenes, penumbrae as wide as the sun's disc makes them.
// Needs `shadow_map`, `sun`, `view`, CASCADES and PCSS.

layout(set = 0, binding = 11, scalar) uniform Cascades {
    mat4 from_world[4]; // the finest first; their maps lie side by side
    vec4 sizes[4];      // metres: from the eye to the sides of the cube it covers, a texel, a unit of depth; unused
    float tan_radius;   // of the sun's disc
} cascades;

// Set by the pipeline, which fits the maps to them.
layout(constant_id = 18) const float NORMAL_OFFSET = 1.0; // of receivers at grazing light, texels
layout(constant_id = 19) const float BLEND = 0.5;         // share of a cube from which on its map is blended into the next
layout(constant_id = 20) const float MAX_RADIUS = 1.0;    // of penumbrae, texels: taps farther apart miss thin casters

// A surface that faces the sun has no slope to be biased by: a tenth of the offset remains, for rounding. For the same reason
// slopes of planes toward grazing light end at ten.
const float MIN_SINE = 0.1;

// Points on discs: of the search for blockers, and of the comparisons.
const int BLOCKER_TAPS = 24;
const int FILTER_TAPS = 48;
// Narrowest disc, texels: as soft as the tent.
const float MIN_RADIUS = 0.75;

/// V by a map, over a 3x3 tent: the mean of four bilinear comparisons half a texel apart. Nine lookups and comparisons give the
/// same and cost a CPU a third of four filtered lookups. `at`: texels of map k.
float tent(vec2 at, float depth, int k, int edge) {
    // So that each of the nine is a texel of this map.
    at = clamp(at, vec2(1.0), vec2(float(edge) - 1.001));
    vec2 centre = floor(at);
    vec2 f = at - centre;
    // Lookups with an offset share their coordinates.
    vec2 uv = (centre + vec2(float(k * edge), 0.0) + 0.5) / vec2(textureSize(shadow_map, 0));
    // Behind all casters, and beside them, the map is empty: depth 0.
    float receiver = max(depth, 0.0);
    vec3 wx = vec3(1.0 - f.x, 1.0, f.x);
    vec3 wy = vec3(1.0 - f.y, 1.0, f.y);
    float lit = 0.0;
#define LIT(x, y) lit += wx[x] * wy[y] * step(textureLodOffset(shadow_map, uv, 0.0, ivec2(x - 1, y - 1)).r, receiver)
    LIT(0, 0); LIT(1, 0); LIT(2, 0);
    LIT(0, 1); LIT(1, 1); LIT(2, 1);
    LIT(0, 2); LIT(1, 2); LIT(2, 2);
    return lit * 0.25;
}

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

/// Point i of n of the unit disc (Vogel 1979: the golden angle, equal areas).
vec2 on_disc(int i, int n) {
    float angle = float(i) * 2.39996323;
    return sqrt((float(i) + 0.5) / float(n)) * vec2(cos(angle), sin(angle));
}

/// Fernando 2005, "Percentage-Closer Soft Shadows", for a disc infinitely far away: the penumbra of a blocker at a distance d
/// is 2 tan(radius) d wide, and V is the share of the disc that is seen past it.
float penumbra(Receiver r, float texel, float depth_metres) {
    float tan_texels = cascades.tan_radius * depth_metres / texel;
    float search = clamp(tan_texels * (1.0 - r.depth), 1.0, MAX_RADIUS);
    float sum = 0.0, blockers = 0.0;
    for (int i = 0; i < BLOCKER_TAPS; ++i) {
        vec2 offset = on_disc(i, BLOCKER_TAPS) * search;
        float above = map_depth(r, ivec2(floor(r.at + offset))) - (r.depth + dot(r.slope, offset));
        if (above > 0.0) { sum += above; blockers += 1.0; }
    }
    if (blockers == 0.0) return 1.0;
    if (blockers == float(BLOCKER_TAPS)) return 0.0;
    float radius = clamp(tan_texels * sum / blockers, MIN_RADIUS, MAX_RADIUS);
    float lit = 0.0;
    for (int i = 0; i < FILTER_TAPS; ++i) lit += lit_at(r, on_disc(i, FILTER_TAPS) * radius);
    return lit / float(FILTER_TAPS);
}

/// V by the map of cascade k.
float in_cascade(int k, vec3 world, vec3 n, float n_dot_l) {
    float texel = cascades.sizes[k].y;
    float sine = max(sqrt(max(1.0 - n_dot_l * n_dot_l, 0.0)), MIN_SINE);
    mat4 map = cascades.from_world[k];
    vec3 p = (map * vec4(world + n * (NORMAL_OFFSET * texel * sine), 1.0)).xyz;
    int edge = textureSize(shadow_map, 0).y;
    vec2 at = (p.xy * 0.5 + 0.5) * float(edge);
    if (!PCSS) return tent(at, p.z, k, edge);
    float depth_metres = cascades.sizes[k].z;
    // Right and up of the map, in the world: its rows, without their scale.
    float scale = 0.5 * float(edge) * texel;
    vec2 across = vec2(dot(vec3(map[0][0], map[1][0], map[2][0]), n), dot(vec3(map[0][1], map[1][1], map[2][1]), n)) * scale;
    vec2 slope = -across / max(n_dot_l, MIN_SINE) * (texel / depth_metres);
    return penumbra(Receiver(at, p.z, slope, k, edge), texel, depth_metres);
}

/// V by the finest map that has the point, blended into the next toward the end of its cube.
float sun_visibility(vec3 world, vec3 n, float n_dot_l) {
    vec3 away = abs(world - view.eye);
    float reach = max(away.x, max(away.y, away.z));
    int k = 0;
    for (int i = 0; i < CASCADES - 1; ++i) if (reach >= cascades.sizes[i].x) k = i + 1;
    float V = in_cascade(k, world, n, n_dot_l);
    if (k + 1 < CASCADES) {
        float blend = (reach / cascades.sizes[k].x - BLEND) / (1.0 - BLEND);
        if (blend > 0.0) V = mix(V, in_cascade(k + 1, world, n, n_dot_l), blend);
    }
    return V;
}
