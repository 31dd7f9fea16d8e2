// The hash table of the cells as the compute passes write it. Needs cell_grid.glsl.

struct Point {
    vec3 position; // world, metres
    uint normal;   // octahedral
};

struct Candidate {
    uint slot;  // NONE: none
    uint place; // of the slot's points
    uint hash;
    Point point;
};

/// Running means of a cell, klx; a: number of samples.
struct Sum {
    vec4 sky;
    vec4 bounce;
};

// Points of a cell: its anchor, and two that new candidates replace.
const uint POINTS = 3u;
// Points of a path that creates cells.
const uint PATH_POINTS = 4u;

// A stage declares the buffers that it uses.
#define PRINTS layout(set = 0, binding = 1, scalar) buffer Prints { uint prints[]; }
#define LIVE layout(set = 0, binding = 2, scalar) buffer Live { uint live_count; uint live[]; }
#define PLACES layout(set = 0, binding = 3, scalar) buffer Places { Point points[]; }
#define CONTESTS layout(set = 0, binding = 4, scalar) buffer Contests { uint contests[]; }
#define CANDIDATES layout(set = 0, binding = 5, scalar) buffer Candidates { Candidate candidates[]; }
#define SUMS layout(set = 0, binding = 6, scalar) buffer Sums { Sum sums[]; }
