#ifndef BSM_PLACE_H
#define BSM_PLACE_H

#include "bitstream/kernel.h"

int64_t place_block(ConstDoubles2 prediction, ConstDoubles2 subspace, ConstInts2 levels, double half_step, Doubles scratch,
                    Doubles2 positions);

#endif
