#ifndef BSM_WEIGHTED_H
#define BSM_WEIGHTED_H

#include "bitstream/kernel.h"

void cotangents(ConstInts offsets, ConstInts neighbours, ConstInts2 faces, ConstDoubles2 positions, Doubles weights);
int64_t hold(ConstInts offsets, ConstInts neighbours, ConstDoubles weights, ConstInts vertices, ConstInts rank,
             Doubles2 matrix, Ints rows, Ints outer, Doubles stiffness);

#endif
