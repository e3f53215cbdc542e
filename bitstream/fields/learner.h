/* A sum of terms whose weights are learnt on the way: recursive least squares, by one sweep of Gauss-Seidel for each
 * sample, in integers (specification, V 6). */
#ifndef BSM_LEARNER_H
#define BSM_LEARNER_H

#include "bitstream/fields/value.h"

enum {
    MOST_TERMS = 7,
    MEMORY = 11,            /* a sample is forgotten after about 2^MEMORY others */
    RIDGE = 1 << 19,        /* pulls weights towards where they started */
    MOST_WEIGHT = 1 << 18,  /* 1.0 is 2^16 */
    MOST_TERM = 1 << 26,
};

typedef struct { /* a row of what Python keeps */
    int64_t square[MOST_TERMS][MOST_TERMS], product[MOST_TERMS]; /* normal equations of the samples; of `square`, the lower half */
    int64_t weight[MOST_TERMS], start[MOST_TERMS];
} Learner;

enum { LEARNER_COLUMNS = sizeof(Learner) / sizeof(int64_t) };

/* The number of terms is a constant wherever this is called, so that loops are unrolled. */
INLINE int32_t foretell(const Learner *l, int terms, const int32_t *term, int32_t most) {
    int64_t sum = 0;
    for (int i = 0; i < terms; i++) sum += term[i] * l->weight[i];
    sum >>= 16;
    return within(sum, -most, most);
}

/* |term| <= MOST_TERM, |target| < 2^30. Samples count by 1 / scale^2, and less where a term or the target is large
 * against that: so sums stay below 2^40, and no outlier spoils them. */
INLINE void take_sample(Learner *l, int terms, const int32_t *term, int32_t target, int32_t scale) {
    int32_t unit = (int32_t)largest(scale, size_of(target) >> 4);
    for (int i = 0; i < terms; i++) unit = (int32_t)largest(unit, size_of(term[i]) >> 5);
    int down = 2 * bit_length((uint32_t)unit + 8) - 8;
    for (int i = 0; i < terms; i++) {
        for (int j = 0; j <= i; j++)
            l->square[i][j] += ((int64_t)term[i] * term[j] * 256 >> down) - (l->square[i][j] >> MEMORY);
        l->product[i] += ((int64_t)term[i] * target * 256 >> down) - (l->product[i] >> MEMORY);
    }
}

/* Bring the weight of term i to its best, the others as they are. */
INLINE void solve_for(Learner *l, int terms, int i) {
    int64_t left = l->product[i] * ONE - RIDGE * (l->weight[i] - l->start[i]);
    for (int j = 0; j < terms; j++) left -= l->square[i > j ? i : j][i > j ? j : i] * l->weight[j];
    int64_t weight = l->weight[i] + left / (l->square[i][i] + RIDGE);
    l->weight[i] = within(weight, -MOST_WEIGHT, MOST_WEIGHT);
}

INLINE void learn(Learner *l, int terms, const int32_t *term, int32_t target, int32_t scale) {
    take_sample(l, terms, term, target, scale);
    for (int i = 0; i < terms; i++) solve_for(l, terms, i);
}

/* The same for one weight: about as good after many samples, and quicker. */
INLINE void learn_in_turn(Learner *l, int terms, const int32_t *term, int32_t target, int32_t scale, int turn) {
    take_sample(l, terms, term, target, scale);
    solve_for(l, terms, turn);
}

#endif
