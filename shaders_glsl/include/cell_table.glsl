// The hash table of the cells as the compute passes write it. Needs cell_grid.glsl.

struct Point {
    vec3 position; // world, metres
    uint normal;   // octahedral
};

struct Candidate {
    uint slot;  // NONE: none
    uint place; // of the slot's contests
    uint hash;
    Point point;
};

/// Running means of a cell.
struct Sum {
    vec3 sky;      // irradiance of the sky, klx
    vec3 bounce;   // irradiance of the bounces, klx
    vec3 sky_gradient;    // of the luminance of `sky`, see cell_gradient.glsl, klx
    vec3 bounce_gradient; // of that of `bounce`
    float samples; // number of paths
    uint hidden;   // neighbours that something hides; from bit 8 on: the level
};

// Points of a cell: its anchor, and one that new candidates replace.
const uint POINTS = 2u;
// Contests of a cell: for one of its points, and for a wall that divides it.
const uint CONTESTS = 2u;
const uint WALL = 1u;
// Most paths of a cell in a round.
const uint MOST_PATHS = 16u;
// Most of those in view besides.
const uint MOST_SEEN_PATHS = 64u;
// Paths until which a cell is young: its light is mostly noise.
const float YOUNG = 32.0;
// Points of a path that creates cells.
const uint PATH_POINTS = 4u;

// A stage declares the buffers that it uses: a device may have no more than four for a stage.

// What is in each slot, its stamp, the slots in use, and how many cells are in view of this round.
#define TABLE layout(set = 0, binding = 1, scalar) buffer Table { uint prints[SLOTS]; uint stamps[SLOTS]; uint seen_count; uint live_count; uint live[SLOTS]; }
// Points and walls of cells.
#define PLACES layout(set = 0, binding = 2, scalar) buffer Places { Point points[SLOTS * POINTS]; uvec2 walls[SLOTS]; }
// The contests for them, and who takes part.
#define CONTESTED layout(set = 0, binding = 3, scalar) buffer Contests { uint contests[SLOTS * CONTESTS]; Candidate candidates[]; }
// Light of cells.
#define SUMS layout(set = 0, binding = 4, scalar) buffer Sums { Sum sums[]; }

/// The hidden neighbours and the level in a word.
uint hidden_pack(uint hidden, int level) {
    return hidden | uint(level) << 8;
}

/// The stamp of a cell that paths from the eye meet in a round: at their first point, where it is in view, or later. Stamps grow.
uint stamp(uint round, bool is_seen) {
    return round << 1 | uint(is_seen);
}

/// The round of a stamp.
uint round_of(uint stamp) {
    return stamp >> 1;
}

/// Whether a cell with this stamp is in view of a round.
bool is_seen(uint stamped, uint round) {
    return stamped == stamp(round, true);
}

/// Whether it is the turn of live cell number `index` of `count`: `turns` of them from `first` on. That of all is so many turns, not a branch:
/// lavapipe compiles a shader anew for each value of a uniform that alone decides one.
bool is_due(uint index, uint count, uint first, uint turns) {
    return (index + count - first % count) % count < turns;
}
