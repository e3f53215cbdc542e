/* Half-edges of a triangle list: number 3 i + k runs from corner k of face i to corner k + 1. */
#ifndef BSM_HALFEDGES_H
#define BSM_HALFEDGES_H

#include "bitstream/kernel.h"

INLINE int32_t next_halfedge(int32_t h) { return h % 3 != 2 ? h + 1 : h - 2; }
INLINE int32_t previous_halfedge(int32_t h) { return h % 3 != 0 ? h - 1 : h + 2; }

int64_t match_halfedges(ConstInts origin, Longs starts, Ints by_high, Ints order, Ints twin);
int64_t find_fans(ConstInts origin, ConstInts twin, Ints corner, Ints vertex);
int64_t fill_loops(ConstInts twin, ConstInts corner, Ints leaving, Ints full_twin, Ints full_corner);

#endif
