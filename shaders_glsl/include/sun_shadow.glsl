// The sun's shadow: a single map, or cascades for large scenes; with PCSS, penumbrae of physical width.
// Needs bvh.glsl, `depth`, `shadow_map`, `sun_glass`, `sun`, `view`, CASCADES and PCSS.

layout(set = 0, binding = 11, scalar) uniform Cascades {
    mat4 from_world[4]; // the finest first; their maps lie side by side
    vec4 sizes[4];      // metres: from the eye to the sides of the cascade's cube, of a texel, of a unit of depth; unused
    float tan_radius;   // of the sun's disc
} cascades;

// Set by the pipeline; the maps are fitted with the same values.
layout(constant_id = 18) const float PLANE_OFFSET = 1.0; // of receivers from walls that stand upright on them, texels
layout(constant_id = 19) const float BLEND = 0.5;         // fraction of a cube's half-width beyond which its map is blended into the next
layout(constant_id = 20) const float MAX_RADIUS = 1.0;    // of penumbrae, texels: taps farther apart would miss thin casters

// Lower limits of the cosine of incidence, so that slopes of receiver planes at grazing light are limited to ten, and of the sine.
const float MIN_COSINE = 0.1;
const float LEAST_SINE = 0.15;
// Error of a plane's depth, texels where the sun is at the zenith of it: the shading normal may be a few degrees off.
const float PLANE_ERROR = 0.05;

// How far along the light walls are looked for that stand on a receiver, texels where the sun is at its zenith; and how far past the
// nearest texel that shows it.
const float FOOT = 8.0;
const float PAST = 1.5;

// Samples on a disc: for the blocker search, and for the comparisons.
const int BLOCKER_TAPS = 24;
const int FILTER_TAPS = 48;
// Smallest filter radius, texels: as soft as the tent.
const float MIN_RADIUS = 0.75;

/// A receiver in the map of cascade k.
struct Receiver {
    vec2 at;      // texels
    float depth;
    vec2 slope;   // of its plane: depth per texel
    float margin; // of depth: nothing so near shadows it
    float error;  // of depth: a texel so near may show its plane
    int k;
    int edge;     // of the map, texels
};

/// The texel nearest to a receiver that shows its plane in the light.
struct Own {
    float apart; // square of its distance, texels; NO_TEXEL: there is none
    vec2 offset; // texels
};

const float NO_TEXEL = 1e9;

Own nearer(Own own, vec2 offset) {
    float apart = dot(offset, offset);
    if (apart < own.apart) return Own(apart, offset);
    return own;
}

/// The sun at a receiver.
struct Sunlit {
    float V;
    float before; // of depth: the caster nearest the sun in the texels around, from the receiver's plane
    Own own;
};

/// V from a map, filtered with a 3x3 tent: the mean of four bilinear comparisons half a texel apart. Nine lookups and comparisons
/// give the same result at a third of the cost of four filtered lookups on a CPU.
Sunlit tent(Receiver r) {
    // Keeps all nine texels inside this map.
    vec2 at = clamp(r.at, vec2(1.0), vec2(float(r.edge) - 1.001));
    vec2 centre = floor(at);
    vec2 f = at - centre;
    // Lookups with constant offsets share one coordinate computation.
    vec2 uv = (centre + vec2(float(r.k * r.edge), 0.0) + 0.5) / vec2(textureSize(shadow_map, 0));
    vec2 to_centre = centre + 0.5 - r.at;
    float depth = r.depth + dot(r.slope, to_centre);
    vec3 wx = vec3(1.0 - f.x, 1.0, f.x);
    vec3 wy = vec3(1.0 - f.y, 1.0, f.y);
    float lit = 0.0;
    float nearest = 0.0;
    Own own = Own(NO_TEXEL, vec2(0.0));
    // Behind and beside all casters the map is empty: depth 0.
#define LIT(i, j) { \
        float before = textureLodOffset(shadow_map, uv, 0.0, ivec2(i - 1, j - 1)).r - max(depth + dot(r.slope, vec2(i - 1, j - 1)), 0.0); \
        lit += wx[i] * wy[j] * step(before, r.margin); \
        nearest = max(nearest, before); \
        if (abs(before) <= r.error) own = nearer(own, to_centre + vec2(i - 1, j - 1)); }
    LIT(0, 0) LIT(1, 0) LIT(2, 0)
    LIT(0, 1) LIT(1, 1) LIT(2, 1)
    LIT(0, 2) LIT(1, 2) LIT(2, 2)
    return Sunlit(lit * 0.25, nearest, own);
}

float map_depth(Receiver r, ivec2 texel) {
    return texelFetch(shadow_map, clamp(texel, ivec2(0), ivec2(r.edge - 1)) + ivec2(r.k * r.edge, 0), 0).r;
}

/// A bilinear comparison with the receiver's plane at an offset of the lookups (texels): 1 is lit. Adds to `own`.
float lit_at(Receiver r, vec2 offset, inout Own own) {
    vec2 at = r.at + offset - 0.5;
    ivec2 base = ivec2(floor(at));
    vec2 f = at - vec2(base);
    vec4 maps = vec4(map_depth(r, base), map_depth(r, base + ivec2(1, 0)),
                     map_depth(r, base + ivec2(0, 1)), map_depth(r, base + ivec2(1, 1)));
    float plane = r.depth + dot(r.slope, vec2(base) + 0.5 - r.at);
    // Behind and beside all casters the map is empty: depth 0.
    vec4 before = maps - max(plane + vec4(0.0, r.slope.x, r.slope.y, r.slope.x + r.slope.y), 0.0);
    if (all(lessThanEqual(abs(before), vec4(r.error)))) own = nearer(own, offset);
    vec4 lit = step(before, vec4(r.margin));
    return mix(mix(lit.x, lit.y, f.x), mix(lit.z, lit.w, f.x), f.y);
}

/// Point i of n on the unit disc (Vogel 1979: golden angle, equal areas).
vec2 on_disc(int i, int n) {
    float angle = float(i) * 2.39996323;
    return sqrt((float(i) + 0.5) / float(n)) * vec2(cos(angle), sin(angle));
}

/// Fernando 2005, "Percentage-Closer Soft Shadows", for a disc at infinity: the penumbra of a blocker at distance d is
/// 2 tan(radius) d wide, and V is the visible fraction of the disc.
Sunlit penumbra(Receiver r, float texel, float depth_metres) {
    float tan_texels = cascades.tan_radius * depth_metres / texel;
    float search = clamp(tan_texels * (1.0 - r.depth), 1.0, MAX_RADIUS);
    float sum = 0.0, blockers = 0.0;
    for (int i = 0; i < BLOCKER_TAPS; ++i) {
        vec2 texel = floor(r.at + on_disc(i, BLOCKER_TAPS) * search);
        float above = map_depth(r, ivec2(texel)) - (r.depth + dot(r.slope, texel + 0.5 - r.at)) - r.margin;
        if (above > 0.0) { sum += above; blockers += 1.0; }
    }
    Own own = Own(NO_TEXEL, vec2(0.0));
    if (blockers == 0.0) return Sunlit(1.0, 0.0, own);
    if (blockers == float(BLOCKER_TAPS)) return Sunlit(0.0, 0.0, own);
    float radius = clamp(tan_texels * sum / blockers, MIN_RADIUS, MAX_RADIUS);
    float lit = 0.0;
    for (int i = 0; i < FILTER_TAPS; ++i) lit += lit_at(r, on_disc(i, FILTER_TAPS) * radius, own);
    return Sunlit(lit / float(FILTER_TAPS), sum / blockers + r.margin, own);
}

/// Right and up axes of map k in world space.
mat2x3 axes_of(int k) {
    mat4 map = cascades.from_world[k];
    float scale = 0.5 * float(textureSize(shadow_map, 0).y) * cascades.sizes[k].y;
    return scale * mat2x3(map[0][0], map[1][0], map[2][0], map[0][1], map[1][1], map[2][1]);
}

/// A point in the map of cascade k. `n`: normal of its plane.
Receiver receiver(int k, vec3 world, vec3 n, float n_dot_l) {
    float texel = cascades.sizes[k].y;
    float texel_depth = texel / cascades.sizes[k].z;
    float sine = max(sqrt(max(1.0 - n_dot_l * n_dot_l, 0.0)), LEAST_SINE);
    float cosine = max(n_dot_l, MIN_COSINE);
    vec3 p = (cascades.from_world[k] * vec4(world, 1.0)).xyz;
    int edge = textureSize(shadow_map, 0).y;
    vec2 across = n * axes_of(k);
    vec2 slope = -across / cosine * texel_depth;
    float margin = PLANE_OFFSET / (sine * cosine) * texel_depth;
    float error = PLANE_ERROR / (cosine * cosine) * texel_depth;
    return Receiver((p.xy * 0.5 + 0.5) * float(edge), p.z, slope, margin, error, k, edge);
}

/// The sun in the map of cascade k.
Sunlit in_cascade(int k, vec3 world, vec3 n, float n_dot_l) {
    Receiver r = receiver(k, world, n, n_dot_l);
    if (!PCSS) return tent(r);
    return penumbra(r, cascades.sizes[k].y, cascades.sizes[k].z);
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

/// The point of a receiver's plane at an offset in map k, texels.
vec3 beside(vec3 world, vec3 n, float n_dot_l, int k, vec2 offset) {
    vec3 across = axes_of(k) * (offset * cascades.sizes[k].y);
    return world + across - sun.direction * (dot(across, n) / max(n_dot_l, MIN_COSINE));
}

/// How far along the light walls are looked for that stand on a receiver, metres.
float foot_of(float n_dot_l, int k) {
    float cosine = max(n_dot_l, MIN_COSINE);
    return FOOT * cascades.sizes[k].y / (cosine * cosine);
}

/// Whether the map shows no caster but walls that stand beside the receiver.
bool is_at_foot(Sunlit lit, float n_dot_l, int k) {
    return 2.0 * lit.before * cascades.sizes[k].z < foot_of(n_dot_l, k);
}

/// V of a point near the edge of a shadow. At the foot of walls and where they meet, the filter and the offsets take light from the other
/// side of them; there rays decide. Ordinary edges of shadows stay as soft as the map has them.
float at_edge(Sunlit lit, vec3 world, vec3 n, float n_dot_l, int k) {
    vec3 origin = lifted_to_eye(world, n, view.eye, corner_error(view.ray_scale, vec2(textureSize(depth, 0))));
    float foot = foot_of(n_dot_l, k);
    bool has_own = lit.own.apart < NO_TEXEL;
    // In a loop, so that the rays are one piece of code.
    for (int ray = 0; ray < 4; ++ray) {
        if ((ray == 1 && !is_at_foot(lit, n_dot_l, k)) || (ray == 2 && !has_own)) continue;
        vec3 toward = sun.direction;
        if (ray == 2) toward = beside(world, n, n_dot_l, k, lit.own.offset * (1.0 + PAST * inversesqrt(max(lit.own.apart, 1e-6)))) - world;
        float far = ray == 0 ? foot : ray == 2 ? 1.0 : FAR;
        bool is_stopped = traced(origin, toward, far, true, ray == 1 ? CUT_OUTS_BLOCK : OPAQUE_ONLY).distance < far;
        // A wall stands on the point, before the sun.
        if (ray == 0 && is_stopped) return 0.0;
        // Walls stand beside the point and not before the sun.
        if (ray == 1 && !is_stopped) return 1.0;
        // The light is that of the point's own side.
        if (ray == 2 && !is_stopped) return lit.V;
        if (ray == 3 && is_stopped) return 0.0;
    }
    return lit.V;
}

/// V from the finest cascade that contains the point, blended into the next toward the side of its cube. `traces`: rays decide at
/// the edges of shadows whether a point is behind a wall.
float sun_visibility(vec3 world, vec3 n, float n_dot_l, bool traces) {
    float reach;
    int k = cascade_of(world, reach);
    Sunlit lit = in_cascade(k, world, n, n_dot_l);
    if (k + 1 < CASCADES) {
        float blend = (reach / cascades.sizes[k].x - BLEND) / (1.0 - BLEND);
        if (blend > 0.0) {
            Sunlit next = in_cascade(k + 1, world, n, n_dot_l);
            lit = Sunlit(mix(lit.V, next.V, blend), max(lit.before, next.before), next.own);
            ++k;
        }
    }
    float error = PLANE_ERROR * cascades.sizes[k].y / cascades.sizes[k].z / max(n_dot_l * n_dot_l, MIN_COSINE * MIN_COSINE);
    bool is_doubtful = lit.before > error && (lit.V > 0.0 || is_at_foot(lit, n_dot_l, k));
    if (traces && is_doubtful) return at_edge(lit, world, n, n_dot_l, k);
    return lit.V;
}
