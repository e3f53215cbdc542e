/* One integer, given predictions of it and what their errors may depend on (specification, V 3 to V 5).
 *
 * Each prediction is taken as the middle of a distribution whose width is learnt; each decision about the value then
 * mixes what these distributions and some adaptive slots say. The front-ends (grid.c, levels.c) make the predictions.
 */
#ifndef BSM_VALUE_H
#define BSM_VALUE_H

#include "bitstream/entropy/mixing.h"

enum {
    FINE = 16, /* predictions and their errors are in 1/16 */
    PREDICTIONS = 7,
    CONTEXTS = 6,
    CONTEXT_SIZE = 512, /* values of a context */
    SCALE_CONTEXTS = 512,
    HIT_CONTEXTS = 32,
    WEIGHT_SETS = 3,
    KINDS = 6, /* of decisions */
    MOST_ASKS = 3,
    VALUE_INPUTS = PREDICTIONS + CONTEXTS + 1,
    /* Nodes of the decisions, by kind. */
    ASK_NODE = 0,
    SIDE_NODE = ASK_NODE + 2 * PREDICTIONS,
    CLASS_NODE = SIDE_NODE + 4,
    PLACE_NODE = CLASS_NODE + 2 * 15,
    VALUE_NODES = PLACE_NODE + 2 * 9,
    VALUE_BYTES = 160, /* more than a value can take */
};

/* As Python keeps it. */
typedef struct {
    Words slots;   /* CONTEXTS x CONTEXT_SIZE x VALUE_NODES */
    Words hits;    /* PREDICTIONS x HIT_CONTEXTS: how often a prediction is exact */
    Ints2 weights; /* VALUE_NODES + WEIGHT_SETS * KINDS rows of VALUE_INPUTS */
    Ints2 scales;  /* PREDICTIONS x SCALE_CONTEXTS rows: mean size of an error in 1/4096, and how often it was seen */
} ValueModel;

typedef struct { /* filled by the front-end */
    int32_t prediction[PREDICTIONS]; /* below 2^28 in magnitude; the last is the best guess */
    int32_t scale;                   /* what to expect of the size of its error, in 1/16; 0 .. 2^28 */
    int32_t asks;                    /* predictions that may be asked for, at most MOST_ASKS */
    int32_t scale_context, hit_context, context[CONTEXTS], set;
} Expectation;

INLINE int32_t whole(int32_t fine) { return (fine + FINE / 2) >> 4; }
INLINE int32_t within(int64_t x, int32_t low, int32_t high) { return x < low ? low : x > high ? high : (int32_t)x; }
INLINE int32_t size_of(int32_t x) { return x < 0 ? -x : x; }
INLINE int32_t bit_length(uint32_t x) { return x != 0 ? 32 - __builtin_clz(x) : 0; }

/* x / n, rounded half away from zero. */
INLINE int32_t divided(int64_t x, int32_t n) { return (int32_t)(x >= 0 ? (x + n / 2) / n : -((-x + n / 2) / n)); }

/* Two to the octave: 0, 1, 2, 3, 4 (to 5), 5 (to 7), 6 (to 11) ... 31. */
INLINE int32_t size_class(int32_t x) {
    if (x < 4) return x;
    int32_t bits = bit_length((uint32_t)x);
    return (int32_t)least(2 * bits - 2 + (x >> (bits - 2) & 1), 31);
}

INLINE int32_t signed_class(int32_t x, int32_t unit) { /* 0 .. 6, 3 in the middle; without branches */
    int32_t size = size_of(x), steps = (size * 2 >= unit) + (size >= unit + (unit >> 1)) + (size >= 4 * unit);
    return x < 0 ? 3 - steps : 3 + steps;
}

INLINE int32_t three_classes(int32_t x, int32_t y, int32_t z, int32_t first, int32_t unit) {
    return (signed_class(x, first) * 7 + signed_class(y, unit)) * 7 + signed_class(z, unit);
}

/* Bit j: prediction j is the value. */
INLINE int32_t hits_of(const Expectation *e, int32_t value) {
    int32_t hits = 0;
    for (int j = 0; j < PREDICTIONS; j++) hits |= (whole(e->prediction[j]) == value) << j;
    return hits;
}

bool fits_values(const ValueModel *model);
/* Codes an integer less than 2^21 away from the best guess; what a reader returns may be 2^24 away. */
int32_t code_value(RangeCoder *coder, const ValueModel *model, const Expectation *e, int32_t value);

#endif
