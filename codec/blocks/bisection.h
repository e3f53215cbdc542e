#ifndef BSM_BISECTION_H
#define BSM_BISECTION_H

#include "bitstream/kernel.h"

/* Words of scratch that a graph of `size` vertices takes. */
INLINE int64_t bisection_scratch(int64_t size) { return 13 * size + 5; }

bool bisect(ConstInts offsets, ConstInts neighbours, Ints order, Ints bounds, Words scratch);
bool bisect_once(ConstInts offsets, ConstInts neighbours, Ints order, Ints bounds, Words scratch, Words second);
bool bisect_half(ConstInts offsets, ConstInts neighbours, Ints order, Ints bounds, int64_t half, Words scratch);

#endif
