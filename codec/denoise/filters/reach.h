#ifndef BSM_DENOISE_REACH_H
#define BSM_DENOISE_REACH_H

#include "bitstream/kernel.h"

int64_t reach(ConstDoubles2 centres, ConstLongs seed_starts, ConstInts seeds, ConstDoubles2 points, ConstLongs starts,
              ConstInts members, ConstDoubles radii, int64_t begin, Ints seen, Longs reached_starts, Ints reached);

#endif
