/* A learnt sum that tells a value, and one that tells how far off that will be (specification, A 4.5). */
#ifndef BSM_FORECAST_H
#define BSM_FORECAST_H

#include "bitstream/attributes/values.h"
#include "bitstream/fields/learner.h"

enum { TERMS = 7, HINTS = 4 };

typedef struct { /* all in 1/16 */
    Learner *guess, *size;
    int32_t term[TERMS], hint[HINTS]; /* filled by the kind; hint 0 is what to expect if there is nothing else */
    int32_t shift, typical;           /* value less base; size of its error */
} Forecast;

INLINE int32_t limited(int64_t term) { return within(term, -MOST_TERM, MOST_TERM); }

/* The learners of a component: one for each number of bases and valence, then one for each number of bases. */
INLINE void choose_learners(Forecast *f, const Values *g, int components, int j, int number, int valence) {
    Learner *learners = (Learner *)g->learners.data;
    f->guess = learners + (j * BASES + number) * VALENCES + valence;
    f->size = learners + components * BASES * VALENCES + j * BASES + number;
}

INLINE void foresee(Forecast *f, int32_t far, bool informed) {
    for (int i = 0; i < TERMS; i++) f->term[i] = limited(f->term[i]);
    for (int i = 0; i < HINTS; i++) f->hint[i] = limited(f->hint[i]);
    f->shift = foretell(f->guess, TERMS, f->term, far);
    f->typical = f->hint[0];
    if (informed) f->typical = within(foretell(f->size, HINTS, f->hint, far), f->hint[0] / 8 + 1, far);
}

/* The value was `error` above the base; returns by how much it was above the guess. */
INLINE int32_t take(Forecast *f, int32_t error) {
    int32_t gap = error - f->shift;
    learn(f->guess, TERMS, f->term, error, f->typical);
    learn(f->size, HINTS, f->hint, (int32_t)least(size_of(gap), 8 * (int64_t)f->typical + 64), f->typical);
    return gap;
}

INLINE int64_t learners_of(int components) { return components * BASES * (VALENCES + 1); }

#endif
