/* Positions on a grid. See grid.py and grid.c. */
#ifndef BSM_GRID_H
#define BSM_GRID_H

#include "bitstream/fields/corners.h"
#include "bitstream/fields/value.h"

/* As Python keeps it. */
typedef struct {
    ConstInts largest; /* 3: values of each axis are 0 .. largest, below 2^20 */
    ConstInts order;   /* n: vertices as they are coded */
    Ints2 values;      /* n x 3 */
    Ints2 gaps;        /* n x 3: value less guess, in 1/16 */
    Longs2 sums;       /* n x 4: values of the coded neighbours, added, and how many they are */
    Longs2 seen;       /* 3 x words: bit v of an axis tells that it has taken the value v */
    Longs2 learners;
} Grid;

int64_t code_grid(Coder coder, ValueModel model, Corners corners, Grid grid, int64_t first, int64_t count);

#endif
