/* Positions on a grid by a small model, vertices as they are numbered. See light.py and light.c. */
#ifndef BSM_LIGHT_H
#define BSM_LIGHT_H

#include "bitstream/entropy/range_coder.h"
#include "bitstream/fields/corners.h"

enum {
    LIGHT_SIZES = 24, /* classes of what is expected of an error */
    LIGHT_KINDS = 12, /* flaps, at most three, and axes before */
    LIGHT_ROW = 12,   /* slots of a size and a kind */
    LIGHT_SPAN = LIGHT_KINDS * LIGHT_ROW + 7, /* slots of a size */
    LIGHT_SLOTS = LIGHT_SIZES * LIGHT_SPAN,
};

/* As Python keeps it. */
typedef struct {
    ConstInts largest; /* 3: values of each axis are 0 .. largest, below 2^20 */
    Ints2 values;      /* n x 3 */
    Ints2 gaps;        /* n x 3: how far values were from guesses, in 1/16 */
    Words slots;       /* LIGHT_SLOTS */
} Light;

int64_t code_light(Coder coder, Corners corners, Light light, int64_t first, int64_t count);

#endif
