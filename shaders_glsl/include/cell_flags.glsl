// The hash table of the cells: buckets of slots, each with a print of its cell and flags; 0 is empty.

const uint SLOT_COLUMNS = 512u;
const uint BUCKETS = 16384u;
const uint BUCKET = 8u;
const uint SLOTS = BUCKETS * BUCKET;

// Flags beside a print.
const uint DIVIDED = 1u;  // a wall divides the cell: it is for the side of its anchor, a sibling for the other
const uint ANCHORED = 2u; // the cell has an anchor
const uint FLAGS = 3u;

ivec2 slot_texel(uint slot) {
    return ivec2(slot % SLOT_COLUMNS, slot / SLOT_COLUMNS);
}

const uint NONE = 0xffffffffu;

// Neighbours of a cell along its surface, in turn, starting beside it: a bit for each that something hides from the anchor.
const ivec2 NEIGHBOURS[8] = ivec2[](ivec2(1, 0), ivec2(1, 1), ivec2(0, 1), ivec2(-1, 1), ivec2(-1, 0), ivec2(-1, -1), ivec2(0, -1), ivec2(1, -1));

/// The bit of a neighbour; 0 for the cell itself.
uint neighbour_bit(ivec2 offset) {
    // Nine places, row by row.
    const uint BITS[9] = uint[](1u << 5, 1u << 6, 1u << 7, 1u << 4, 0u, 1u << 0, 1u << 3, 1u << 2, 1u << 1);
    return BITS[3 * (offset.y + 1) + offset.x + 1];
}

// Bits of the number of samples in the published state; those of hidden neighbours follow.
const uint SAMPLE_BITS = 16u;
