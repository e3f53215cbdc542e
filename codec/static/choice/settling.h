/* See settling.c. */
#ifndef BSM_SETTLING_H
#define BSM_SETTLING_H

#include "bitstream/kernel.h"

int64_t settle_levels(ConstDoubles2 offsets, ConstDoubles2 normals, ConstDoubles2 losses, ConstDoubles2 steps,
                      ConstDoubles reach, ConstInts starts, ConstInts members, ConstDoubles2 rates, double pull, int64_t fixed,
                      Ints2 levels, Doubles2 counts);

#endif
