/* Vertices that are where an image is: one decision for three values (specification, V 17.11).
 *
 * Where parts repeat on the grid itself, the cell of a twin's image is right in most cases, and three values at
 * nearly no bits each still cost more than one decision. Up to two candidates are asked, the better trusted first; a
 * refuted cell is not asked again, nor coded by value. */
#include "bitstream/fields/twins.h"

enum { AXES = 3, LIMIT = 255, RATE = 14 };

INLINE bool same_cell(const int32_t *a, const int32_t *b) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2]; }

INLINE void find_cell(const Candidate *c, const int32_t *largest, int32_t *cell) {
    for (int j = 0; j < AXES; j++) cell[j] = whole(within(c->place[j], 0, FINE * largest[j]));
}

/* A class of a sum over the axes. */
INLINE int32_t sum_class(int64_t sum, int32_t most) {
    return (int32_t)least(size_class((int32_t)least(sum >> 2, ONE)), most);
}

/* What is known of a vertex: its expected place, the answers at its first flap, and the class of the errors nearby. */
typedef struct {
    const int32_t *base;
    int32_t hits, errors;
} Known;

/* Code whether a vertex is in the cell of candidate c. `beside` is 0 for the last candidate, 1 if the next one has the
 * same cell, else 2. */
static int code_hit(RangeCoder *coder, Twins *t, const Candidate *c, const int32_t *cell, int32_t beside,
    const Known *known, int bit) {
    int32_t trust = t->image[c->image].trust, support = (int32_t)least(c->support, 3), off = 0;
    int64_t away = 0;
    for (int j = 0; j < AXES; j++) {
        off += size_of(c->place[j] - FINE * cell[j]);
        away += size_of(c->place[j] - known->base[j]);
    }
    int32_t latest = t->latest[c->image] & 15;
    int64_t context[WHOLE_CONTEXTS] = {
        ((trust >> 12) * 4 + support) * 2 + c->same_degree,
        (known->hits * 3 + beside) * 4 + support,
        ((c->image * 3 + beside) * 2 + c->same_degree) * 2 + (support > 1),
        (latest * 3 + (off >= 3) + (off >= 9)) * 3 + beside,
        sum_class(away, 23) * 16 + known->errors,
    };
    for (int i = 0; i < WHOLE_CONTEXTS; i++) context[i] = 2 * (context[i] + i * CONTEXT_SIZE);
    int trusted = (trust >= ONE / 5) + (trust >= ONE / 2) + (trust >= ONE / 5 * 4);
    Bank bank = {t->whole_slot, t->whole_weight, LIMIT, RATE};
    bit = code_decision(coder, &bank, WHOLE_CONTEXTS, context, t->misses, 2 * trusted, bit);
    t->latest[c->image] = 2 * latest + bit;
    return bit;
}

bool code_whole(RangeCoder *coder, Twins *t, const Corners *corners, const Ints2 *values, const Around *around,
    int32_t v, const int32_t *base, const int32_t *near, const int32_t *largest) {
    int32_t *x = values->data + AXES * (int64_t)v;
    t->misses = 0;
    if (!is_reading(coder) && t->wanted) mend_place(corners, *values, t->wanted, largest, v);
    if (t->candidates == 0) return false;
    const Flap *f = around->flap;
    Known known = {base, around->flaps > 0 ? (t->hit[f->a] * 3 + t->hit[f->b]) * 3 + t->hit[f->c] : 0,
        sum_class((int64_t)near[0] + near[1] + near[2], 15)};
    for (int i = 0; i < t->candidates && t->misses < MOST_MISSES; i++) {
        int32_t *cell = t->missed[t->misses], next[AXES] = {0};
        find_cell(t->candidate + i, largest, cell);
        if (t->misses > 0 && same_cell(cell, t->missed[0])) continue;
        if (i + 1 < t->candidates) find_cell(t->candidate + i + 1, largest, next);
        int32_t beside = i + 1 == t->candidates ? 0 : same_cell(next, cell) ? 1 : 2;
        int bit = !is_reading(coder)
            && (same_cell(x, cell) || (t->wanted && go_to_cell(corners, *values, t->wanted, v, cell)));
        bit = code_hit(coder, t, t->candidate + i, cell, beside, &known, bit);
        if (t->misses == 0) t->hit[v] = (uint8_t)(1 + bit);
        for (int j = 0; j < AXES && bit; j++) x[j] = cell[j];
        if (bit) return true;
        t->misses++;
    }
    return false;
}
