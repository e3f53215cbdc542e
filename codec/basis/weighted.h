#ifndef BSM_WEIGHTED_H
#define BSM_WEIGHTED_H

#include "bitstream/kernel.h"

void cotangents(ConstInts offsets, ConstInts neighbours, ConstInts2 faces, ConstDoubles2 positions, double flatness,
                double smallness, Doubles weights);
int64_t hold(ConstInts offsets, ConstInts neighbours, ConstDoubles weights, ConstInts rank, ConstInts vertices,
             ConstInts own_offsets, ConstInts own_neighbours, Doubles inner, Doubles springs, Ints starts, Ints outer,
             Doubles stiffness);
void pull(ConstInts starts, ConstInts outer, ConstDoubles stiffness, ConstDoubles2 field, Doubles2 pulls);

#endif
