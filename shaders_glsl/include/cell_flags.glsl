// The hash table of the cells: buckets of slots, each with a print of its cell and flags; 0 is empty.

const uint SLOT_COLUMNS = 512u;
const uint BUCKETS = 16384u;
const uint BUCKET = 8u;
const uint SLOTS = BUCKETS * BUCKET;

// Flags beside a print.
const uint MIXED = 1u;    // surfaces in this cell do not all see its anchor
const uint ANCHORED = 2u; // the cell has an anchor
const uint EDGED = 4u;    // something stands between the anchor and the neighbouring cells
const uint FLAGS = 7u;

ivec2 slot_texel(uint slot) {
    return ivec2(slot % SLOT_COLUMNS, slot / SLOT_COLUMNS);
}

const uint NONE = 0xffffffffu;
