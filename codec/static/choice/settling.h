/* See settling.c. */
#ifndef BSM_SETTLING_H
#define BSM_SETTLING_H

#include "bitstream/kernel.h"

int64_t settle_levels(ConstDoubles2 wanted, ConstDoubles2 losses, ConstDoubles steps, ConstDoubles reach, ConstInts starts,
                      ConstInts members, ConstDoubles rates, double pull, double unit, int64_t sweeps, Ints2 levels);

#endif
