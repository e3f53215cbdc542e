#ifndef BSM_SORT_H
#define BSM_SORT_H

#include "bitstream/kernel.h"

/* Sort values that nearly always come nearly sorted: by insertion, and by a heap once that has moved too many of them,
 * so that none, however many and in whatever order, take more than n log n steps. */
INLINE void sort_ascending(int32_t *values, int64_t size) {
    int64_t moves = 32 * size, sorted = 1;
    for (; sorted < size && moves > 0; sorted++) {
        int32_t value = values[sorted];
        int64_t j = sorted;
        for (; j > 0 && values[j - 1] > value; j--) values[j] = values[j - 1];
        values[j] = value;
        moves -= sorted - j;
    }
    if (sorted >= size) return;
    for (int64_t start = size / 2, end = size; end > 1;) {
        if (start > 0) {
            start--;
        } else {
            end--;
            int32_t value = values[end];
            values[end] = values[0];
            values[0] = value;
        }
        int64_t root = start;
        int32_t value = values[root];
        for (int64_t child = 2 * root + 1; child < end; child = 2 * root + 1) {
            if (child + 1 < end && values[child + 1] > values[child]) child++;
            if (values[child] <= value) break;
            values[root] = values[child];
            root = child;
        }
        values[root] = value;
    }
}

#endif
