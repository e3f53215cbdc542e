/* The model of a sequence's levels, and of columns of whole numbers (specification, S 4.1). */
#ifndef BSMDEC_LEVELS_H
#define BSMDEC_LEVELS_H

#include "engine/coding.h"

MUST_CHECK INLINE bool make_level_bank(Arena *arena, Bank *bank) {
    enum { INPUTS = 6, UNARY = 14, SPAN = SIGNED_SPAN(UNARY) + 3, ALIKE = 12, PLACES = 40 };
    return make_bank(arena, (BankPlan){.slots = ((INPUTS - 1) * ALIKE * ALIKE + ALIKE * PLACES) * SPAN, .selectors = 3 * SPAN,
                                .inputs = INPUTS, .limit = 400, .rate = 10}, bank);
}

#endif
