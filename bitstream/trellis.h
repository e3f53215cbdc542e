/* Dependent quantization: which of two grids a level is on (specification, M 9.11). */
#pragma once

#include "bitstream/kernel.h"

enum { TRELLIS_STATES = 8 };

/* Number of the grid that the next level is on. */
INLINE int trellis_grid(int state) { return state & 1; }

/* State after `level`. */
INLINE int trellis_following(int state, int32_t level) {
    return ((state << 1) & (TRELLIS_STATES - 1)) | ((state ^ (state >> 1) ^ (state >> 2) ^ level) & 1);
}

/* The value of `level`, in half steps. */
INLINE int32_t trellis_point(int state, int32_t level) {
    if (level > 0) return 2 * level - trellis_grid(state);
    return level < 0 ? 2 * level + trellis_grid(state) : level;
}

/* Coefficients of the levels of a block, for half steps of this size. */
INLINE void values_of_levels(const int32_t *levels, int64_t count, double half_step, double *values) {
    int state = 0;
    for (int64_t i = 0; i < count; i++) {
        values[i] = (double)trellis_point(state, levels[i]) * half_step;
        state = trellis_following(state, levels[i]);
    }
}
