#ifndef BSM_DETAIL_H
#define BSM_DETAIL_H

#include "bitstream/kernel.h"

void block_normals(ConstInts2 faces, ConstLongs starts, ConstInts members, ConstInts vertices, Ints place,
                   ConstDoubles2 positions, double softness, double least_length, Doubles2 normals);
int64_t raise_block(ConstInts2 faces, ConstLongs starts, ConstInts members, ConstInts vertices, Ints place,
                    double softness, double least_length, ConstDoubles2 subspace, ConstInts2 levels, int64_t count,
                    double half_step, Doubles scratch, Doubles2 positions);

#endif
