// The sun's shadow: a single map, or cascades for large scenes; with PCSS, penumbrae of physical width.
// Needs `shadow_map`, `sun_glass`, `sun`, `view`, CASCADES and PCSS.

layout(set = 0, binding = 11, scalar) uniform Cascades {
    mat4 from_world[4]; // the finest first; their maps lie side by side
    vec4 sizes[4];      // metres: from the eye to the sides of the cascade's cube, of a texel, of a unit of depth; unused
    float tan_radius;   // of the sun's disc
} cascades;

// Set by the pipeline; the maps are fitted with the same values.
layout(constant_id = 18) const float NORMAL_OFFSET = 1.0; // of receivers at grazing light, texels
layout(constant_id = 19) const float BLEND = 0.5;         // fraction of a cube's half-width beyond which its map is blended into the next
layout(constant_id = 20) const float MAX_RADIUS = 1.0;    // of penumbrae, texels: taps farther apart would miss thin casters

// Lower limit of the sine and cosine of incidence: a surface that faces the sun keeps a tenth of the normal offset, against
// rounding, and slopes of receiver planes at grazing light are limited to ten.
const float MIN_SINE = 0.1;

// Samples on a disc: for the blocker search, and for the comparisons.
const int BLOCKER_TAPS = 24;
const int FILTER_TAPS = 48;
// Smallest filter radius, texels: as soft as the tent.
const float MIN_RADIUS = 0.75;

/// V from a map, filtered with a 3x3 tent: the mean of four bilinear comparisons half a texel apart. Nine lookups and comparisons
/// give the same result at a third of the cost of four filtered lookups on a CPU. `at`: texels of map k.
float tent(vec2 at, float depth, int k, int edge) {
    // Keeps all nine texels inside this map.
    at = clamp(at, vec2(1.0), vec2(float(edge) - 1.001));
    vec2 centre = floor(at);
    vec2 f = at - centre;
    // Lookups with constant offsets share one coordinate computation.
    vec2 uv = (centre + vec2(float(k * edge), 0.0) + 0.5) / vec2(textureSize(shadow_map, 0));
    // Behind and beside all casters the map is empty: depth 0.
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
    vec2 slope;  // of its plane: depth per texel
    int k;
    int edge;    // of the map, texels
};

float map_depth(Receiver r, ivec2 texel) {
    return texelFetch(shadow_map, clamp(texel, ivec2(0), ivec2(r.edge - 1)) + ivec2(r.k * r.edge, 0), 0).r;
}

/// A bilinear comparison with the receiver's plane at an offset (texels): 1 is lit.
float lit_at(Receiver r, vec2 offset) {
    vec2 at = r.at + offset - 0.5;
    ivec2 base = ivec2(floor(at));
    vec2 f = at - vec2(base);
    vec4 maps = vec4(map_depth(r, base), map_depth(r, base + ivec2(1, 0)),
                     map_depth(r, base + ivec2(0, 1)), map_depth(r, base + ivec2(1, 1)));
    // Behind and beside all casters the map is empty: depth 0.
    vec4 lit = step(maps, vec4(max(r.depth + dot(r.slope, offset), 0.0)));
    return mix(mix(lit.x, lit.y, f.x), mix(lit.z, lit.w, f.x), f.y);
}

/// Point i of n on the unit disc (Vogel 1979: golden angle, equal areas).
vec2 on_disc(int i, int n) {
    float angle = float(i) * 2.39996323;
    return sqrt((float(i) + 0.5) / float(n)) * vec2(cos(angle), sin(angle));
}

/// Fernando 2005, "Percentage-Closer Soft Shadows", for a disc at infinity: the penumbra of a blocker at distance d is
/// 2 tan(radius) d wide, and V is the visible fraction of the disc.
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

/// V from the map of cascade k.
float in_cascade(int k, vec3 world, vec3 n, float n_dot_l) {
    float texel = cascades.sizes[k].y;
    float sine = max(sqrt(max(1.0 - n_dot_l * n_dot_l, 0.0)), MIN_SINE);
    mat4 map = cascades.from_world[k];
    vec3 p = (map * vec4(world + n * (NORMAL_OFFSET * texel * sine), 1.0)).xyz;
    int edge = textureSize(shadow_map, 0).y;
    vec2 at = (p.xy * 0.5 + 0.5) * float(edge);
    if (!PCSS) return tent(at, p.z, k, edge);
    float depth_metres = cascades.sizes[k].z;
    // The map's right and up axes in world space: its rows without their scale.
    float scale = 0.5 * float(edge) * texel;
    vec2 across = vec2(dot(vec3(map[0][0], map[1][0], map[2][0]), n), dot(vec3(map[0][1], map[1][1], map[2][1]), n)) * scale;
    vec2 slope = -across / max(n_dot_l, MIN_SINE) * (texel / depth_metres);
    return penumbra(Receiver(at, p.z, slope, k, edge), texel, depth_metres);
}

/// What panes between the sun and a point of map k let through: bilinear between texels. Panes behind the point count too if another one
/// is before it, in line with the sun.
vec3 glass_at(vec2 at, float depth, int k, int edge) {
    vec2 base = floor(at - 0.5), f = at - 0.5 - base;
    vec3 through = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        ivec2 texel = clamp(ivec2(base) + corner, ivec2(0), ivec2(edge - 1)) + ivec2(k * edge, 0);
        vec4 glass = texelFetch(sun_glass, texel, 0);
        vec2 w = mix(1.0 - f, f, vec2(corner));
        through += w.x * w.y * (glass.a > depth ? glass.rgb : vec3(1.0));
    }
    return through;
}

/// The cascade of a point, the finest that contains it, and the point's distance in it.
int cascade_of(vec3 world, out float reach) {
    vec3 away = abs(world - view.eye);
    reach = max(away.x, max(away.y, away.z));
    int k = 0;
    for (int i = 0; i < CASCADES - 1; ++i) if (reach >= cascades.sizes[i].x) k = i + 1;
    return k;
}

/// What panes let through of the sun's light.
vec3 sun_tint(vec3 world) {
    float reach;
    int k = cascade_of(world, reach);
    vec3 p = (cascades.from_world[k] * vec4(world, 1.0)).xyz;
    int edge = textureSize(sun_glass, 0).y;
    return glass_at((p.xy * 0.5 + 0.5) * float(edge), p.z, k, edge);
}

/// V from the finest cascade that contains the point, blended into the next toward the side of its cube.
float sun_visibility(vec3 world, vec3 n, float n_dot_l) {
    float reach;
    int k = cascade_of(world, reach);
    float V = in_cascade(k, world, n, n_dot_l);
    if (k + 1 < CASCADES) {
        float blend = (reach / cascades.sizes[k].x - BLEND) / (1.0 - BLEND);
        if (blend > 0.0) V = mix(V, in_cascade(k + 1, world, n, n_dot_l), blend);
    }
    return V;
}
