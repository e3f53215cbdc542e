/* Learners on rows as vectors where registers are long: of `square`, both halves. Behind the terms are zeros. */
#pragma once

#include "bitstream/fields/fields.h"

#if KERNEL_ISA == 4 || (defined(__AVX512F__) && defined(__AVX512VL__) && defined(__AVX512DQ__))
#define BSM_WIDE
typedef __attribute__((vector_size(64))) int64_t Terms;
typedef __attribute__((vector_size(64), __aligned__(8), may_alias)) int64_t UnalignedTerms;
typedef __attribute__((vector_size(32), __aligned__(4), may_alias)) int32_t UnalignedWholes;

INLINE Terms terms_at(const int64_t *row) { return *(const UnalignedTerms *)row; }

INLINE void fade_and_add(int64_t *row, Terms sample) {
    Terms old = terms_at(row);
    *(UnalignedTerms *)row = old + sample - (old >> LEARNER_MEMORY);
}

INLINE void take_sample_wide(Learner *l, int terms, const int32_t *term, int32_t target, int32_t scale) {
    int down = fineness(terms, term, target, scale);
    Terms all = __builtin_convertvector(*(const UnalignedWholes *)term, Terms) * 256;
    for (int i = 0; i < terms; i++) fade_and_add(l->square[i], all * term[i] >> down);
    fade_and_add(l->product, all * target >> down);
}

/* The same as `learn_in_turn`. */
INLINE void learn_wide_in_turn(
    Learner *l, int terms, const int32_t *term, int32_t target, int32_t scale, int turn) {
    take_sample_wide(l, terms, term, target, scale);
    solve_for(l, terms, turn);
}
#else
#define learn_wide_in_turn learn_in_turn
#endif
