/* Edges across which an attribute changes, and the corners that share a value (specification, A 3 and A 4). */
#include "bitstream/attributes/attributes.h"

enum {
    KNOWN = 3, WRITTEN = 4, /* what both sides know of it; that it is a seam, which only a writer knows yet */
    INPUTS = 4,
    ENDS = 32, /* states of a vertex */
    OTHERS = 9,
    ENDS_CONTEXT = 0,
    OTHERS_CONTEXT = ENDS_CONTEXT + ENDS * ENDS,
    SIDES_CONTEXT = OTHERS_CONTEXT + OTHERS * 16,
    OTHER_CONTEXT = SIDES_CONTEXT + 256,
    SLOTS = OTHER_CONTEXT + OTHERS,
};
INSIDE const BankPlan EDGE_BANK = {.slots = SLOTS, .selectors = OTHERS, .inputs = INPUTS};

enum { KNOWN_SEAMS, LEFT, BORDER, END_COLUMNS }; /* of a vertex: seams that are known, edges that are not, open edges */

/* Of an end of an edge. */
INLINE int state_of(const int32_t *end) {
    return (int)(least(end[KNOWN_SEAMS], 3) * 8 + least(end[LEFT], 3) * 2 + (end[BORDER] > 0));
}

INLINE bool code_edge(RangeCoder *coder, const Bank *bank, const Corners *c, const uint8_t *seams,
    const uint8_t *others, int32_t *ends, int32_t k, bool seam) {
    int32_t beyond = c->opposite.data[k];
    int32_t *u = ends + END_COLUMNS * c->faces.data[next_corner(k)],
        *v = ends + END_COLUMNS * c->faces.data[previous_corner(k)];
    u[LEFT]--;
    v[LEFT]--;
    int su = state_of(u), sv = state_of(v);
    int high = (int)largest(su, sv), low = (int)least(su, sv), pair = (high >> 3) * 4 + (low >> 3);
    int here = (seams[next_corner(k)] & KNOWN) * 4 + (seams[previous_corner(k)] & KNOWN);
    int there = (seams[next_corner(beyond)] & KNOWN) * 4 + (seams[previous_corner(beyond)] & KNOWN);
    int other = others[k];
    const int64_t contexts[INPUTS] = {
        ENDS_CONTEXT + high * ENDS + low,
        OTHERS_CONTEXT + other * 16 + pair,
        SIDES_CONTEXT + here * 16 + there,
        OTHER_CONTEXT + other,
    };
    seam = code_mixed_bit(coder, bank, INPUTS, contexts, 0, other, seam);
    u[KNOWN_SEAMS] += seam;
    v[KNOWN_SEAMS] += seam;
    return seam;
}

/* Count the edges of each vertex, and forget seams that a reader does not know yet. */
static void begin_edges(const Corners *corners, uint8_t *seam, Ints2 ends) {
    for (int64_t i = 0; i < END_COLUMNS * ends.rows; i++) ends.data[i] = 0;
    for (int64_t f = 0; f < corners->faces.rows; f++) {
        int32_t *end[3];
        for (int j = 0; j < 3; j++) end[j] = ends.data + END_COLUMNS * corners->faces.data[3 * f + j];
        for (int j = 0; j < 3; j++) {
            int64_t k = 3 * f + j;
            int32_t beyond = corners->opposite.data[k], *u = end[(j + 1) % 3], *v = end[(j + 2) % 3];
            if (beyond < 0) u[BORDER]++, v[BORDER]++;
            else if (beyond > k) u[LEFT]++, v[LEFT]++;
            seam[k] = beyond < 0 ? OPEN : (uint8_t)(UNKNOWN | (seam[k] == SEAM ? WRITTEN : 0));
        }
    }
}

INLINE void code_all_edges(
    RangeCoder *coder, const Bank *bank, const Corners *corners, uint8_t *seam, const uint8_t *others, Ints2 ends) {
    for (int32_t k = 0; k < corners->corners.size && !overran(coder); k++) {
        int32_t beyond = corners->opposite.data[k];
        if (beyond <= k) continue;
        bool is_seam = code_edge(coder, bank, corners, seam, others, ends.data, k, seam[k] & WRITTEN);
        seam[k] = seam[beyond] = is_seam ? SEAM : NO_SEAM;
    }
}

/* Code for each edge that two corners face whether it is a seam; `seams` has an entry for each corner, for the edge
 * that it faces. `ends`: three numbers for each vertex, scratch. */
void code_edges(
    RangeCoder *coder, const Bank *bank, const Corners *corners, uint8_t *seam, const uint8_t *others, Ints2 ends) {
    RangeCoder own = *coder; /* in registers */
    begin_edges(corners, seam, ends);
    if (is_reading(coder)) {
        own.reading = true; /* the compiler leaves out the writer */
        code_all_edges(&own, bank, corners, seam, others, ends);
    } else {
        code_all_edges(&own, bank, corners, seam, others, ends);
    }
    *coder = own;
}

int32_t first_joined(int32_t *joined, int32_t k) {
    while (joined[k] != k) k = joined[k] = joined[joined[k]];
    return k;
}

void join_two(int32_t *joined, int32_t a, int32_t b) {
    a = first_joined(joined, a);
    b = first_joined(joined, b);
    joined[largest(a, b)] = (int32_t)least(a, b);
}

/* Give corners of one vertex that meet at an edge which is not a seam one number, numbers in the order of their first
 * corners, which come into `first`. Returns how many there are. */
int64_t join_corners(Corners corners, ConstBytes seams, Ints joined, Ints first) {
    int64_t size = corners.corners.size;
    const int32_t *vertex = corners.faces.data;
    for (int32_t k = 0; k < size; k++) joined.data[k] = k;
    for (int32_t k = 0; k < size; k++) {
        int32_t beyond = corners.opposite.data[k];
        if (beyond <= k || seams.data[k] != NO_SEAM) continue;
        int32_t a = next_corner(k), b = previous_corner(k), c = next_corner(beyond), d = previous_corner(beyond);
        bool turned = vertex[a] != vertex[d]; /* the faces run along the edge in one direction */
        join_two(joined.data, a, turned ? c : d);
        join_two(joined.data, b, turned ? d : c);
    }
    int32_t count = 0;
    for (int32_t k = 0; k < size; k++) { /* a corner is joined to one before it, which has its number, or to itself */
        if (joined.data[k] != k) {
            joined.data[k] = joined.data[joined.data[k]];
        } else {
            first.data[count] = k;
            joined.data[k] = -1 - count++;
        }
    }
    for (int32_t k = 0; k < size; k++) joined.data[k] = -1 - joined.data[k];
    return count;
}
