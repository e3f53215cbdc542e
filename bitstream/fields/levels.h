/* Levels around a prediction. See levels.py and levels.c. */
#ifndef BSM_LEVELS_FIELD_H
#define BSM_LEVELS_FIELD_H

#include "bitstream/entropy/mixing.h"
#include "bitstream/fields/corners.h"

/* As Python keeps it; each n x 3 but the last. */
typedef struct {
    Ints2 levels; /* at most 2^20 in magnitude */
    Ints2 gaps;   /* level less guess, in 1/16 */
    Ints2 means;  /* of a level and those of its coded neighbours, in 1/16 */
    Longs2 learners;
} Levels;

int64_t code_levels(Coder coder, Bank bank, Corners corners, Levels levels, int64_t first, int64_t count);

#endif
