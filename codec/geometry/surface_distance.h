#ifndef BSM_SURFACE_DISTANCE_H
#define BSM_SURFACE_DISTANCE_H

#include "bitstream/kernel.h"

int64_t build_tree(ConstDoubles2 lowest, ConstDoubles2 highest, Longs order, Longs scratch, Doubles2 low,
                   Doubles2 high, Longs first, Longs count);
void nearest_distances(ConstDoubles2 points, ConstDoubles2 triangles, ConstDoubles2 low, ConstDoubles2 high,
                       ConstLongs first, ConstLongs count, Doubles distances);

#endif
